// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photographs/grid.h"
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <fresco/core/point_set.h>
#include <vector>
namespace fresco::texture {
/// Part of a picture with a hole in it.
struct HolePicture {
  enum : std::uint8_t { outside = 0, known = 1, hole = 2 };
  static constexpr float per_level = 4;      ///< stored numbers per grey level
  using Color = std::array<std::int16_t, 4>; ///< red, green, blue, 0: 500 grey levels either way
  int width = 0, height = 0;
  std::vector<Color> color;        ///< rows from the top
  std::vector<std::uint8_t> state; ///< what each pixel is; pixels outside are not looked at

  std::size_t at(int x, int y) const { return cellAt(x, y, width); }

  static Eigen::Vector4f levels(const Color& color)
  {
    return Eigen::Vector4f(color[0], color[1], color[2], 0) / per_level;
  }
  static Color stored(const Eigen::Vector4f& levels)
  {
    Color out{};
    for (int c = 0; c < 3; ++c)
      out[c] = std::lrint(per_level * levels[c]);
    return out;
  }
};

/// Fills the hole so that each 7x7 window of it looks like some window of the known part, coarse to fine: Wexler,
/// Shechtman & Irani 2007, "Space-Time Completion of Video", with the search of Barnes et al. 2009, "PatchMatch".
/// @param seed of the random search; same seed, same result
/// @return false, and nothing done, if there are too few known windows
bool synthesizeHole(HolePicture& picture, std::uint64_t seed);

/// Largest distance of a hole pixel from what is not hole, pixels (chessboard).
int holeRadius(const HolePicture& picture);
} // namespace fresco::texture
