// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/atlas_paint.h"
#include <algorithm>
namespace fresco::texture {
/// What a photograph shows more than was predicted of the texture, in grey levels of corrected colours, each pixel
/// times how far it is to be trusted (0..1).
struct PhotoError {
  int width = 0, height = 0;
  std::vector<Eigen::Vector4f> pixels; ///< rows from the top; red, green, blue, 0

  /// Bilinear mean around a place in pixels.
  Eigen::Vector4f at(float x, float y) const
  {
    const float u = std::clamp(x - 0.5f, 0.f, static_cast<float>(width - 1)),
                v = std::clamp(y - 0.5f, 0.f, static_cast<float>(height - 1));
    const int i = std::min(static_cast<int>(u), width - 2), j = std::min(static_cast<int>(v), height - 2);
    const float a = u - static_cast<float>(i), b = v - static_cast<float>(j);
    const Eigen::Vector4f *p = pixels.data() + static_cast<std::size_t>(j) * width + i, *q = p + width;
    return (1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * q[0] + a * q[1]);
  }
};

/// The textured patches that a photograph shows.
struct Prediction {
  const PaintScene& scene;
  const std::vector<Image>& atlases;
  const Projector& view;
  const int *first, *last; ///< patches
};

/// A pixel is predicted as the mean of what bilinear interpolation of the texels gives over its area. Pixels that the
/// patches cover in part or more than once, at outlines for instance, are trusted little or not.
PhotoError errorOf(const Prediction& prediction, const Image& photo, const Eigen::Vector3f& gain);

/// Bytes of errorOf()'s result.
std::size_t errorBytes(const CameraModel& camera);
} // namespace fresco::texture
