// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
#include <fresco/texture/core/texture_reconstruction.h>
namespace fresco::texture {
/// @throws std::invalid_argument unless each face with area has finite texture coordinates in 0..1 that exist
void validateLayout(const TexturedMesh& model);

/// Charts of a model that has texture coordinates: its islands, at their places. Gives the model's atlases their sizes:
/// those that they have, or `options.atlas` for the longest side.
/// @param density F, texels per mesh unit wanted for each face: size of the atlases that have none
/// @throws std::invalid_argument naming a face that covers texels of another
std::vector<Chart> keepLayout(const PatchMesh& patches, const FaceGraph& graph, const Eigen::VectorXf& density,
                              const TextureOptions& options, TexturedMesh& model);
} // namespace fresco::texture
