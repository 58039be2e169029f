// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/cube_map.h"
#include <vector>
namespace fresco::registration {
/// How far a scan saw at most in a cone of directions: an upper bound from tiles of cells of a cube map. Of a place behind
/// walls it tells in one look-up that the scan says nothing.
class FarthestTiles {
public:
  static constexpr float widest = 0.15f; ///< half the angle of a cone, radians: a block of points some metres away

  FarthestTiles() = default;

  /// @param farthest per cell of a cube map with 6 * side * side cells
  FarthestTiles(const std::vector<float>& farthest, int side);

  bool empty() const { return farthest_.empty(); }

  /// At least the largest `farthest` of all cells that directions within the widest angle of `direction` fall into.
  float around(const Eigen::Vector3f& direction) const { return farthest_[cubeCell(direction, side_)]; }

private:
  int side_ = 0;
  std::vector<float> farthest_; ///< per tile, of all tiles near it
};
} // namespace fresco::registration
