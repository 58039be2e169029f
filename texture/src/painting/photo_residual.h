// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/patch_map.h"
#include "painting/atlas_paint.h"
#include "photographs/grid.h"
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

  /// visit(lane, bilinear mean around a place in pixels, in stored numbers) for the first `count` places.
  template <typename Visit>
  void at(const Pixels& places, int count, const Visit& visit) const
  {
    const auto within = [](const simd::Float4& v, int most) {
      return simd::smaller(simd::larger(v - 0.5f, simd::Float4{}), simd::Float4{} + float(most));
    };
    const simd::Float4 u = within(places.x, width - 1), v = within(places.y, height - 1);
    const simd::Int4 i = simd::smaller(__builtin_convertvector(u, simd::Int4), simd::Int4{} + (width - 2)),
                     j = simd::smaller(__builtin_convertvector(v, simd::Int4), simd::Int4{} + (height - 2));
    const simd::Float4 a = u - __builtin_convertvector(i, simd::Float4),
                       b = v - __builtin_convertvector(j, simd::Float4), right = a * (1 - b), below = (1 - a) * b,
                       both = a * b;
    const simd::Float4 left = (1 - a) * (1 - b);
    const auto floats = [](const Pixel& pixel) { return simd::floatsOf(pixel.data()); };
    for (int lane = 0; lane < count; ++lane) {
      const Pixel *p = pixels.data() + cellAt(i[lane], j[lane], width), *q = p + width;
      visit(lane, left[lane] * floats(p[0]) + right[lane] * floats(p[1]) + below[lane] * floats(q[0]) +
                      both[lane] * floats(q[1]));
    }
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
