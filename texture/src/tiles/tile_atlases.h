// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tiles/mesh_tiles.h"
#include <fresco/texture/core/texture_reconstruction.h>
namespace fresco::texture {
struct Tiling {
  Index faces;    ///< most of a tile, > 0
  AtlasSink take; ///< empty: atlases are kept
};

/// Puts what was painted tile by tile together: texture coordinates, numbers of atlases, figures.
class TileAtlases {
public:
  /// @param result whose mesh the tiles are of
  TileAtlases(const AtlasSink& take, TextureResult& result);

  /// @param painted mesh of the tile's faces and those around it; atlases of the tile alone
  void add(const MeshTiles& tiles, Index tile, TextureResult painted);
  void finish();

private:
  void takeFaces(const MeshTiles& tiles, Index tile, const TextureResult& painted);
  void takeAtlases(TextureResult& painted);

  const AtlasSink& take_;
  TextureResult& result_;
  Array<float> texcoords_;
  double area_ = 0, seen_ = 0, texels_ = 0, owned_ = 0;
  std::vector<std::pair<double, double>> sizes_; ///< of a texel, with areas
};

/// Leaves out faces of the same corners in the same order, with a warning. @return whether there are any
bool removeDuplicates(const MeshTiles& tiles, TriangleMesh& mesh, std::vector<std::string>& warnings);
} // namespace fresco::texture
