// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/grey_pyramid.h"
#include <algorithm>
#include <cmath>
namespace fresco::texture {
namespace {
Image greyOf(const Image& photo)
{
  Image out(photo.width, photo.height, 1);
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const std::uint8_t* p = photo.data.data() + 3 * i;
    out.data[i] = (299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000;
  }
  return out;
}

Image halved(const Image& in)
{
  Image out(in.width / 2, in.height / 2, 1);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      *out.pixel(x, y) = (*in.pixel(2 * x, 2 * y) + *in.pixel(2 * x + 1, 2 * y) + *in.pixel(2 * x, 2 * y + 1) +
                          *in.pixel(2 * x + 1, 2 * y + 1) + 2) /
                         4;
  return out;
}

/// Mean square change of grey in the direction of least change.
double cornerness(const Image& image, int x, int y)
{
  constexpr int corner_radius = 3; // pixels, window of the structure tensor: more than noise, less than a patch
  double xx = 0, xy = 0, yy = 0;
  for (int j = y - corner_radius; j <= y + corner_radius; ++j)
    for (int i = x - corner_radius; i <= x + corner_radius; ++i) {
      const double dx = 0.5 * (*image.pixel(i + 1, j) - *image.pixel(i - 1, j)),
                   dy = 0.5 * (*image.pixel(i, j + 1) - *image.pixel(i, j - 1));
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
  const double mean = 0.5 * (xx + yy), split = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
  return (mean - split) / ((2 * corner_radius + 1) * (2 * corner_radius + 1));
}
} // namespace

GreyPyramid buildPyramid(const Image& photo, const PyramidSize& size)
{
  const std::size_t most = size.most_pixels;
  GreyPyramid out;
  Image level = greyOf(photo);
  while (level.data.size() > most) {
    Image half = halved(level);
    if (size.fine)
      out.fine = std::move(level);
    level = std::move(half);
    out.scale *= 0.5;
  }
  out.levels.push_back(std::move(level));
  while (std::min(out.levels.back().width, out.levels.back().height) >= 64)
    out.levels.push_back(halved(out.levels.back()));
  return out;
}

float greyAt(const Image& image, float x, float y)
{
  const float u = x - 0.5f, v = y - 0.5f;
  const int i = u, j = v;
  const float a = u - i, b = v - j;
  const std::uint8_t *p = image.pixel(i, j), *q = p + image.width;
  return (1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * q[0] + a * q[1]);
}

std::vector<Eigen::Vector2f> findCorners(const Image& image, int cells)
{
  std::vector<Eigen::Vector2f> out;
  constexpr int corner_border = 2 * (patch_radius + 1);
  constexpr double least_change = 4; // grey levels per pixel, RMS in the direction of least change: above noise
  const double width = image.width - 2.0 * corner_border, height = image.height - 2.0 * corner_border;
  if (!(width > 0 && height > 0))
    return out;
  const double side = std::sqrt(width * height / cells);
  const int nx = std::max<int>(1, width / side), ny = std::max<int>(1, height / side);
  for (int cy = 0; cy < ny; ++cy)
    for (int cx = 0; cx < nx; ++cx) {
      double best = least_change * least_change;
      Eigen::Vector2f place(-1, -1);
      const int left = cx * width / nx, right = (cx + 1) * width / nx, top = cy * height / ny,
                bottom = (cy + 1) * height / ny;
      for (int y = corner_border + top; y < corner_border + bottom; y += 2)
        for (int x = corner_border + left; x < corner_border + right; x += 2)
          if (const double value = cornerness(image, x, y); value > best) {
            best = value;
            place = {x + 0.5f, y + 0.5f};
          }
      if (place.x() > 0)
        out.push_back(place);
    }
  return out;
}
} // namespace fresco::texture
