// SPDX-License-Identifier: BSD-3-Clause
#include "reference_frame.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
namespace fresco::tracking {
namespace {
/// Pixels around one whose depths give its normal: as wide as noise asks for at the finest level, where a pixel is
/// smallest.
int radiusAt(int width) { return width >= 240 ? 2 : 1; }

/// Value and gradient (per pixel) of an image between its pixels; false at its border.
bool sampled(const Plane& image, float u, float v, float (&out)[3])
{
  if (!(u >= 1.f && v >= 1.f && u < image.width - 2 && v < image.height - 2))
    return false;
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  const float fu = u - x, fv = v - y;
  const auto at = [&](int dx, int dy) {
    const float *upper = image.row(y + dy) + x + dx, *lower = upper + image.width;
    return (upper[0] * (1 - fu) + upper[1] * fu) * (1 - fv) + (lower[0] * (1 - fu) + lower[1] * fu) * fv;
  };
  out[0] = at(0, 0);
  out[1] = 0.5f * (at(1, 0) - at(-1, 0));
  out[2] = 0.5f * (at(0, 1) - at(0, -1));
  return true;
}
} // namespace

SmoothDepth smoothDepth(const Plane& depth, const Pinhole& camera, int x, int y, int radius)
{
  constexpr float steepest = 4.f; // tangent of the angle between surface and image, 76 degrees
  const float z = depth.row(y)[x];
  if (!(z > 0.f))
    return {};
  const float within = z * radius * steepest / camera.fx;
  float sum = 0, along_x = 0, along_y = 0, squares = 0;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) {
      const float other = depth.row(y + dy)[x + dx];
      if (!(std::fabs(other - z) <= within)) // another surface, or none
        return {};
      const float inverse = 1.f / other;
      sum += inverse;
      along_x += dx * inverse;
      along_y += dy * inverse;
      squares += dx * dx;
    }
  const int side = 2 * radius + 1;
  const float mean = sum / (side * side), a = along_x / squares, b = along_y / squares;
  const Eigen::Vector3f direction((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.f);
  Eigen::Vector3f normal(a * camera.fx, b * camera.fy, 0.f);
  normal.z() = mean - normal.x() * direction.x() - normal.y() * direction.y();
  return {1.f / mean, normal.normalized()};
}

ReferenceLevel::ReferenceLevel(const RgbdLevel& level, const RgbdCameras& cameras)
{
  const Plane& depth = level.depth;
  const Pinhole K = halved(cameras.depth, level.depth_halvings), C = halved(cameras.color, level.gray_halvings);
  const int radius = radiusAt(depth.width);
  struct Sample {
    Eigen::Vector3f p, n, g;
    float intensity;
  };
  std::vector<Sample> samples;
  samples.reserve(depth.data.size());
  std::vector<float> depths;
  for (int y = radius; y < depth.height - radius; ++y)
    for (int x = radius; x < depth.width - radius; ++x) {
      const SmoothDepth smooth = smoothDepth(depth, K, x, y, radius);
      if (!(smooth.z > 0.f))
        continue;
      Sample s{smooth.z * Eigen::Vector3f((x - K.cx) / K.fx, (y - K.cy) / K.fy, 1.f),
               smooth.normal / depthDeviation(smooth.z), Eigen::Vector3f::Zero(), 0.f};
      const Eigen::Vector3f q = s.p + cameras.color_from_depth;
      float gray[3];
      if (level.gray.width > 0 && q.z() > 0.f &&
          sampled(level.gray, q.x() / q.z() * C.fx + C.cx, q.y() / q.z() * C.fy + C.cy, gray)) {
        s.intensity = gray[0];
        s.g << gray[1] * C.fx / q.z(), gray[2] * C.fy / q.z(),
            -(gray[1] * C.fx * q.x() + gray[2] * C.fy * q.y()) / (q.z() * q.z());
      }
      samples.push_back(s);
      depths.push_back(smooth.z);
    }
  size_ = samples.size();
  padded_ = (size_ + 7) / 8 * 8;
  data_.assign(rows * padded_, 0.f);
  std::fill(row(2), row(2) + padded_, 1.f);
  for (Index i = 0; i < size_; ++i) {
    for (int k = 0; k < 3; ++k) {
      row(k)[i] = samples[i].p[k];
      row(3 + k)[i] = samples[i].n[k];
      row(6 + k)[i] = samples[i].g[k];
    }
    row(9)[i] = samples[i].intensity;
  }
  median_depth = depths.empty() ? 0 : median(depths);
}

ReferenceArrays ReferenceLevel::arrays() const
{
  return {row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7), row(8), row(9)};
}

ReferenceFrame makeReference(const RgbdPyramid& pyramid, const RgbdCameras& cameras)
{
  ReferenceFrame reference;
  for (const RgbdLevel& level : pyramid.levels)
    reference.emplace_back(level, cameras);
  return reference;
}
} // namespace fresco::tracking
