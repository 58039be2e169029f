// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <fresco/core/image.h>
#include <fresco/core/types.h>
#include <vector>
namespace fresco::texture {
constexpr int patch_radius = 5; ///< pixels: 11 x 11 are distinct enough, and the surface is still flat over them

/// Grey levels of a photograph, each level half as wide as the one before.
struct GreyPyramid {
  std::vector<Image> levels; ///< one channel
  double scale = 1;          ///< pixels of level 0 per pixel of the photograph: 1, 1/2, 1/4 ...
  Image fine; ///< twice as wide as level 0; empty where that is the photograph itself or this is not asked for
};

struct PyramidSize {
  Index most_pixels; ///< of level 0
  bool fine;
};
GreyPyramid buildPyramid(const Image& photo, const PyramidSize& size);

/// Grey level at a place in pixels (bilinear); the place lies at least one pixel inside.
float greyAt(const Image& image, float x, float y);

/// Places where the image changes in every direction, the best of each cell of a grid; pixels of `image`.
/// Shi & Tomasi 1994, "Good Features to Track".
std::vector<Eigen::Vector2f> findCorners(const Image& image, int cells);
} // namespace fresco::texture
