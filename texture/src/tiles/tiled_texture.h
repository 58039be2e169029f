// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tiles/tile_atlases.h"
namespace fresco::texture {
/// reconstructTexture() tile by tile: what is painted at a time is a tile of the mesh with its surroundings.
/// 1. Cameras and photometry come from a coarse mesh.
/// 2. Depth maps of the photographs see the whole mesh, which comes to them tile by tile.
/// 3. Views are chosen for each tile, with what lies around as far as the choice reaches. Each face keeps the choice of its
///    own tile.
/// 4. Each tile is painted, by the choices of all. Where it meets tiles that are done, the offsets of seam levelling and
///    the colours of unseen surface are theirs.
TextureResult textureInTiles(TriangleMesh mesh, const std::vector<TextureView>& views, const TextureOptions& options,
                             const Progress& progress, const Tiling& tiling);
} // namespace fresco::texture
