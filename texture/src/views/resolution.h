// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "cameras/projector.h"
#include "views/patch_mesh.h"
namespace fresco::texture {
/// P, pixels per mesh unit in each patch's view, mean of the directions on the surface; 0 where unseen.
Eigen::VectorXf patchResolutions(const PatchMesh& patches, const std::vector<Projector>& views,
                                 const Eigen::VectorXi& view);

/// Side of a pixel on the surface, mesh units, median over the patches; 0 where nothing is seen.
double pixelSize(const Eigen::VectorXf& resolution);

/// F, texels per mesh unit for each face.
/// @param texel mesh units; 0 = as the photographs show it, and coarsely where none does
Eigen::VectorXf wantedDensities(const PatchMesh& patches, Index faces, const Eigen::VectorXf& resolution, double texel);
} // namespace fresco::texture
