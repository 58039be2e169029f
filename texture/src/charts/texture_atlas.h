// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
#include <fresco/texture/core/texture_reconstruction.h>
namespace fresco::texture {
/// Lays the mesh out into charts and packs them: fills the model's texture coordinates, its empty atlases and masks,
/// and the figures that say how. Where the photographs would give more texels than memory should hold, texels are made
/// larger, with a warning.
/// @param resolution P, pixels per mesh unit in each patch's view, 0 where unseen
std::vector<Chart> makeAtlas(const PatchMesh& patches, const Eigen::VectorXf& resolution, const TextureOptions& options,
                             TextureResult& result);

/// F, chart of each face, -1 = none.
Eigen::VectorXi chartsOfFaces(const std::vector<Chart>& charts, Index faces);
} // namespace fresco::texture
