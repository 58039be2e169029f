// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "grid.h"
#include "painting/atlas_paint.h"
#include <algorithm>
#include <array>
#include <cstdint>
#include <fresco/core/simd.h>
namespace fresco::texture {
/// What a photograph shows more than was predicted of the texture, in grey levels of corrected colours, each pixel
/// times how far it is to be trusted (0..1).
struct PhotoResidual {
  static constexpr float per_level = 2; ///< stored numbers per grey level: as fine as noise; what is above 63 is cut
  using Pixel = std::array<std::int8_t, 4>;
  int width = 0, height = 0;
  std::vector<Pixel> pixels; ///< rows from the top; red, green, blue, 0

  /// Bilinear mean around a place in pixels, in stored numbers.
  simd::Float4 at(float x, float y) const
  {
    const float u = std::clamp<float>(x - 0.5f, 0, width - 1), v = std::clamp<float>(y - 0.5f, 0, height - 1);
    const int i = std::min<int>(u, width - 2), j = std::min<int>(v, height - 2);
    const float a = u - i, b = v - j;
    const Pixel *p = pixels.data() + cellAt(i, j, width), *q = p + width;
    const auto floats = [](const Pixel& pixel) { return simd::floatsOf(pixel.data()); };
    return (1 - b) * ((1 - a) * floats(p[0]) + a * floats(p[1])) + b * ((1 - a) * floats(q[0]) + a * floats(q[1]));
  }
};

/// How many texels of a row can be taken as one, since together they are no wider than a pixel.
/// @param steps of one texel, see PatchMap::steps()
int texelsPerPixel(const Eigen::Matrix2f& steps);

/// The textured patches that a photograph shows.
struct Prediction {
  const PaintScene& scene;
  const std::vector<Image>& atlases;
  const Projector& view;
  const std::vector<int>& patches;
};

/// A pixel is predicted as the mean of what bilinear interpolation of the texels gives over its area. Pixels that the
/// patches cover in part or more than once, at outlines for instance, are trusted little or not. So are those that differ
/// much where the photograph is off.
/// @param error by which it is off from others, pixels
PhotoResidual residualOf(const Prediction& prediction, const Image& photo, const PixelGain& gain, float error);
} // namespace fresco::texture
