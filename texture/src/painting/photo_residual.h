// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "grid.h"
#include "painting/atlas_paint.h"
#include <algorithm>
namespace fresco::texture {
/// What a photograph shows more than was predicted of the texture, in grey levels of corrected colours, each pixel
/// times how far it is to be trusted (0..1).
struct PhotoResidual {
  int width = 0, height = 0;
  std::vector<Eigen::Vector4f> pixels; ///< rows from the top; red, green, blue, 0

  /// Bilinear mean around a place in pixels.
  Eigen::Vector4f at(float x, float y) const
  {
    const float u = std::clamp<float>(x - 0.5f, 0, width - 1), v = std::clamp<float>(y - 0.5f, 0, height - 1);
    const int i = std::min<int>(u, width - 2), j = std::min<int>(v, height - 2);
    const float a = u - i, b = v - j;
    const Eigen::Vector4f *p = pixels.data() + cellAt(i, j, width), *q = p + width;
    return (1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * q[0] + a * q[1]);
  }
};

/// The textured patches that a photograph shows.
struct Prediction {
  const PaintScene& scene;
  const std::vector<Image>& atlases;
  const Projector& view;
  const std::vector<int>& patches;
};

/// A pixel is predicted as the mean of what bilinear interpolation of the texels gives over its area. Pixels that the
/// patches cover in part or more than once, at outlines for instance, are trusted little or not.
PhotoResidual residualOf(const Prediction& prediction, const Image& photo, const PixelGain& gain);

/// Bytes of residualOf()'s result.
std::size_t residualBytes(const CameraModel& camera);
} // namespace fresco::texture
