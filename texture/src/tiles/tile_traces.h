// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tiles/mesh_tiles.h"
#include "views/patch_mesh.h"
namespace fresco::texture {
/// What tiles leave for those around them: views and colours of their patches.
class TileTraces {
public:
  /// Of the next tile.
  /// @param view of all patches
  void add(const TileMesh& tile, const PatchMesh& patches, const Eigen::VectorXi& view);
  /// Once the tile is painted. @param colors 3xP of its own patches, 0..255
  void setColors(Index tile, const Points& colors);

  /// Patches of the tile's own faces, the first ones.
  static Index ownPatches(const TileMesh& tile, const PatchMesh& patches);
  /// Of its own patches.
  const Array<int>& viewsOf(Index tile) const { return traces_[tile].view; }
  /// P, as chosen by the patch's own tile.
  Eigen::VectorXi views(const TileMesh& tile, Index number, const PatchMesh& patches) const;
  /// 3xP, colours of patches around the tile that are painted; -1: not known
  Points colors(const TileMesh& tile, const PatchMesh& patches) const;

private:
  template <typename Visit>
  void forAround(const TileMesh& tile, const PatchMesh& patches, const Visit& visit) const;

  struct Trace {
    Array<int> first;          ///< of each own face, into `view`; and the end
    Array<int> view;           ///< of each patch, -1 = unseen
    Array<std::uint8_t> color; ///< 3 of each patch, once it is painted
  };
  std::vector<Trace> traces_;
};
} // namespace fresco::texture
