// SPDX-License-Identifier: BSD-3-Clause
#include "rgbd_pyramid.h"
#include <algorithm>
#include <cmath>
namespace fresco::tracking {
namespace {
constexpr int finest_width = 400;  // pixels: finer images cost time, and their depths are no less noisy for it
constexpr int coarsest_width = 40; // pixels: fewer hold no pose

Plane depthPlane(const Image16& image, const DepthRules& rules)
{
  Plane plane(image.width, image.height);
  const auto low = static_cast<float>(rules.nearest), high = static_cast<float>(rules.farthest);
  const auto unit = static_cast<float>(rules.unit);
  for (std::size_t i = 0; i < plane.data.size(); ++i) {
    const float z = unit * image.data[i];
    plane.data[i] = image.data[i] != 65535 && z >= low && z <= high ? z : 0.f;
  }
  return plane;
}

Plane grayPlane(const Image& image)
{
  Plane plane(image.width, image.height);
  const std::uint8_t* from = image.data.data();
  if (image.channels < 3)
    std::copy(from, from + plane.data.size(), plane.data.begin());
  else
    for (std::size_t i = 0; i < plane.data.size(); ++i, from += image.channels)
      plane.data[i] = 0.299f * from[0] + 0.587f * from[1] + 0.114f * from[2];
  return plane;
}

/// Mean of the nearest of 2 x 2 depths and of those beside it on the same surface.
Plane halfDepth(const Plane& fine)
{
  Plane half(fine.width / 2, fine.height / 2);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      const float *upper = fine.row(2 * y) + 2 * x, *lower = upper + fine.width;
      const float four[4] = {upper[0], upper[1], lower[0], lower[1]};
      float least = 1e9f;
      for (const float z : four)
        least = z > 0.f ? std::min(least, z) : least;
      float sum = 0.f, count = 0.f;
      for (const float z : four) {
        const bool same = z > 0.f && z <= least * (1.f + one_surface);
        sum += same ? z : 0.f;
        count += same ? 1.f : 0.f;
      }
      half.row(y)[x] = count > 0.f ? sum / count : 0.f;
    }
  return half;
}

Plane halfGray(const Plane& fine)
{
  Plane half(fine.width / 2, fine.height / 2);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      const float *upper = fine.row(2 * y) + 2 * x, *lower = upper + fine.width;
      half.row(y)[x] = 0.25f * (upper[0] + upper[1] + lower[0] + lower[1]);
    }
  return half;
}

double deviation(const Plane& plane)
{
  double sum = 0, squares = 0;
  for (const float value : plane.data) {
    sum += value;
    squares += value * value;
  }
  const double n = std::max<double>(1.0, plane.data.size());
  return std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));
}
} // namespace

Pinhole halved(const CameraModel& camera, int times)
{
  const double scale = std::ldexp(1.0, -times);
  return {float(scale * camera.fx), float(scale * camera.fy), float(scale * camera.cx - 0.5),
          float(scale * camera.cy - 0.5)};
}

RgbdPyramid makePyramid(const RgbdImage& image, const DepthRules& rules)
{
  RgbdLevel level{depthPlane(image.depth, rules), {}, 0, 0};
  if (!image.color.empty())
    level.gray = grayPlane(image.color);
  for (; level.depth.width > finest_width; ++level.depth_halvings)
    level.depth = halfDepth(level.depth);
  for (; level.gray.width > finest_width; ++level.gray_halvings)
    level.gray = halfGray(level.gray);
  RgbdPyramid pyramid;
  pyramid.levels.push_back(std::move(level));
  const RgbdLevel& finest = pyramid.levels[0];
  const auto seen = std::count_if(finest.depth.data.begin(), finest.depth.data.end(), [](float z) { return z > 0.f; });
  pyramid.depth_share = double(seen) / finest.depth.data.size();
  while (pyramid.levels.back().depth.width / 2 >= coarsest_width) {
    const RgbdLevel& last = pyramid.levels.back();
    RgbdLevel next{halfDepth(last.depth), {}, last.depth_halvings + 1, last.gray_halvings + 1};
    if (last.gray.width > 0)
      next.gray = halfGray(last.gray);
    pyramid.levels.push_back(std::move(next));
  }
  constexpr double least_contrast = 2; // grey levels: a covered lens; there is nothing but noise
  if (deviation(pyramid.levels.back().gray) < least_contrast)
    for (RgbdLevel& any : pyramid.levels)
      any.gray = {};
  return pyramid;
}
} // namespace fresco::tracking
