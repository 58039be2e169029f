// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/isosurface/isosurface.h"
#include <fresco/surface/core/volumetric_reconstruction.h>
namespace fresco::poisson {
/// A rank's part of the surface without small components, see removeSmallComponents().
struct SurfacePart {
  IsoSurface surface; ///< own vertices and faces; the faces hold numbers of vertices of the whole
  std::vector<VolumetricPart::Run> vertices, faces; ///< where they lie in the whole
  Index vertex_count = 0, face_count = 0;           ///< of the whole
};

SurfacePart extractSurfacePart(const Octree& tree, std::vector<NodeField>&& chi, float level_set, int threads);
} // namespace fresco::poisson
