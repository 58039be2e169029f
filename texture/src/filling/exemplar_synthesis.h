// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "grid.h"
#include <Eigen/Core>
#include <cstdint>
#include <fresco/core/point_set.h>
#include <vector>
namespace fresco::texture {
/// Part of a picture with a hole in it.
struct HolePicture {
  enum : std::uint8_t { outside = 0, known = 1, hole = 2 };
  int width = 0, height = 0;
  std::vector<Eigen::Vector4f> color; ///< rows from the top; the last of the four is 0: processors add four at once
  std::vector<std::uint8_t> state;    ///< what each pixel is; pixels outside are not looked at

  std::size_t at(int x, int y) const { return cellAt(x, y, width); }
};

/// Fills the hole so that each 7x7 window of it looks like some window of the known part, coarse to fine: Wexler,
/// Shechtman & Irani 2007, "Space-Time Completion of Video", with the search of Barnes et al. 2009, "PatchMatch".
/// @param seed of the random search; same seed, same result
/// @return false, and nothing done, if there are too few known windows
bool synthesizeHole(HolePicture& picture, std::uint64_t seed);

/// Largest distance of a hole pixel from what is not hole, pixels (chessboard).
int holeRadius(const HolePicture& picture);
} // namespace fresco::texture
