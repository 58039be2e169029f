// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
#include "photographs/projector.h"
#include <fresco/texture/core/texture_reconstruction.h>
namespace fresco::texture {
/// P, pixels per mesh unit in each patch's view, mean of the directions on the surface; 0 where unseen.
Eigen::VectorXf patchResolutions(const PatchMesh& patches, const std::vector<Projector>& views,
                                 const Eigen::VectorXi& view);

/// Side of a pixel on the surface, mesh units, median over the patches; 0 where nothing is seen.
double pixelSize(const Eigen::VectorXf& resolution);

/// Those of what lays out charts as TextureOptions does.
template <class Options>
TextureOptions layoutOptions(const Options& options)
{
  TextureOptions out;
  out.texel = options.texel;
  out.atlas = options.atlas;
  out.border = options.border;
  out.threads = options.threads;
  return out;
}

/// Lays the mesh out into charts and packs them: fills the model's texture coordinates, its empty atlases and masks,
/// and the figures that say how. Where the photographs would give more texels than memory should hold, texels are made
/// larger, with a warning.
/// @param resolution P, pixels per mesh unit in each patch's view, 0 where unseen
/// @param result of whose faces the first `own` get texture coordinates. The others are around a tile: their charts, the
///        last ones, go to atlases of their own behind those of the tile
std::vector<Chart> makeAtlas(const PatchMesh& patches, const Eigen::VectorXf& resolution, const TextureOptions& options,
                             TextureResult& result, Index own);
} // namespace fresco::texture
