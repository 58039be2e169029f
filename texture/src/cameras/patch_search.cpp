// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/patch_search.h"
#include "photographs/grid.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>
namespace fresco::texture {
namespace {
constexpr int side = 2 * patch_radius + 1, count = side * side;

/// Patch with mean 0 and norm 1.
using Template = std::array<float, count>;

constexpr int fine = -1; // level of GreyPyramid::fine

const Image& imageOf(const GreyPyramid& pyramid, int level)
{
  return level == fine ? pyramid.fine : pyramid.levels[level];
}

bool takeTemplate(const PatchQuery& query, int level, Template& out)
{
  constexpr float least_deviation = 3; // grey levels: below, the patch is mostly noise
  const Image& image = imageOf(query.from, level);
  const float scale = std::ldexp(1.f, -level);
  float sum = 0, squares = 0;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const Eigen::Vector2f p =
          query.pixel_from * scale +
          query.T_from_to * Eigen::Vector2f(i - patch_radius, j - patch_radius); // offsets scale alike
      if (!(p.x() >= 1 && p.y() >= 1 && p.x() < image.width - 1 && p.y() < image.height - 1))
        return false;
      const float v = out[j * side + i] = greyAt(image, p.x(), p.y());
      sum += v;
      squares += v * v;
    }
  const float mean = sum / count, norm = std::sqrt(std::max(0.f, squares - sum * mean));
  if (!(norm > least_deviation * side))
    return false;
  for (float& v : out)
    v = (v - mean) / norm;
  return true;
}

struct Peak {
  int x = 0, y = 0;
  float value = -1, second = -1; ///< second: best more than two pixels away
};

/// Grey levels of a square region with the sums over all its squares from the corner, so that mean and spread of any
/// patch in it cost nothing.
class Region {
public:
  /// @param low upper left pixel; the region lies inside the image
  Region(const Image& image, Eigen::Vector2i low, Eigen::Vector2i size)
      : width_(size.x()), grey_(cellCount(size.x(), size.y()) + 1, 0.f),
        sums_(cellCount(size.x() + 1, size.y() + 1), 0), squares_(sums_)
  {
    for (int y = 0; y < size.y(); ++y) {
      const std::uint8_t* row = image.pixel(low.x(), low.y() + y);
      std::int64_t sum = 0, square = 0;
      for (int x = 0; x < width_; ++x) {
        grey_[cellAt(x, y, width_)] = row[x];
        sum += row[x];
        square += row[x] * row[x];
        sums_[at(x + 1, y + 1)] = sums_[at(x + 1, y)] + sum;
        squares_[at(x + 1, y + 1)] = squares_[at(x + 1, y)] + square;
      }
    }
  }

  /// With the patch whose upper left pixel is (x, y) of the region.
  float correlation(const Template& patch, int x, int y) const
  {
    float product = 0;
    for (int j = 0; j < side; ++j) {
      const float *row = grey_.data() + cellAt(x, y + j, width_), *wanted = patch.data() + j * side;
      for (int i = 0; i < side; ++i)
        product += wanted[i] * row[i];
    }
    const float sum = box(sums_, x, y);
    const float spread = box(squares_, x, y) - sum * sum / count;
    return spread > 1 ? product / std::sqrt(spread) : -1;
  }

private:
  std::size_t at(int x, int y) const { return cellAt(x, y, width_ + 1); }
  std::int64_t box(const std::vector<std::int64_t>& sums, int x, int y) const
  {
    return sums[at(x + side, y + side)] - sums[at(x, y + side)] - sums[at(x + side, y)] + sums[at(x, y)];
  }

  int width_;
  std::vector<float> grey_;
  std::vector<std::int64_t> sums_, squares_;
};

/// Correlation of the template with the patch centred on pixel (x, y); -1 outside the image.
float correlation(const Template& patch, const Image& image, int x, int y)
{
  if (x < patch_radius || y < patch_radius || x >= image.width - patch_radius || y >= image.height - patch_radius)
    return -1;
  return Region(image, {x - patch_radius, y - patch_radius}, {side, side}).correlation(patch, 0, 0);
}

Peak findPeak(const Template& patch, const Image& image, Eigen::Vector2i at, int reach)
{
  Peak peak;
  const Eigen::Array2i low = (at.array() - reach).max(patch_radius),
                       high = (at.array() + reach).min(Eigen::Array2i(image.width, image.height) - 1 - patch_radius);
  if ((low > high).any())
    return peak;
  const Region region(image, low - patch_radius, high - low + side);
  std::vector<float> values;
  for (int y = low.y(); y <= high.y(); ++y)
    for (int x = low.x(); x <= high.x(); ++x) {
      values.push_back(region.correlation(patch, x - low.x(), y - low.y()));
      if (values.back() > peak.value)
        peak = {x, y, values.back(), -1};
    }
  std::size_t i = 0;
  for (int y = low.y(); y <= high.y(); ++y)
    for (int x = low.x(); x <= high.x(); ++x, ++i)
      if (std::max(std::abs(x - peak.x), std::abs(y - peak.y)) > 2)
        peak.second = std::max(peak.second, values[i]);
  return peak;
}

/// Top of the parabola through three values at -1, 0, 1.
float parabolaVertex(float before, float middle, float after)
{
  const float curvature = before - 2 * middle + after;
  return curvature < -1e-6f ? std::clamp(0.5f * (before - after) / curvature, -0.5f, 0.5f) : 0.f;
}

/// Grey levels around a place, with one pixel more to each side for their derivatives.
class Surroundings {
public:
  Surroundings(const Image& image, const Eigen::Vector2f& place)
  {
    for (int j = 0; j < wide; ++j)
      for (int i = 0; i < wide; ++i)
        grey_[j * wide + i] = greyAt(image, place.x() + i - patch_radius - 1, place.y() + j - patch_radius - 1);
  }

  /// Of pixel (i, j) of the patch: derivatives in x and y, grey level.
  Eigen::Vector3d at(int i, int j) const
  {
    const float* p = grey_.data() + (j + 1) * wide + i + 1;
    return {0.5 * (p[1] - p[-1]), 0.5 * (p[wide] - p[-wide]), p[0]};
  }

private:
  static constexpr int wide = side + 2;
  std::array<float, wide * wide> grey_;
};

/// Moves the place to where the patch fits best under any gain and offset of grey levels, by Gauss-Newton steps: Lucas &
/// Kanade 1981. @return false if that is not near where it began
bool fitPlace(const Template& patch, const Image& image, Eigen::Vector2f& place)
{
  constexpr int most_steps = 10;
  constexpr float enough = 0.01f, reach = 1; // pixels: far below the scatter of matches; the peak is in the next pixel
  constexpr int spare = patch_radius + 2;
  const Eigen::Vector2f start = place;
  for (int step = 0; step < most_steps; ++step) {
    if (!((place - start).norm() <= reach && place.minCoeff() >= spare && place.x() < image.width - spare &&
          place.y() < image.height - spare))
      return false;
    const Surroundings grey(image, place);
    Eigen::Matrix4d H = Eigen::Matrix4d::Zero(); // shift, gain, offset
    Eigen::Vector4d g = Eigen::Vector4d::Zero();
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const Eigen::Vector3d here = grey.at(i, j);
        const Eigen::Vector4d J(here.x(), here.y(), -patch[j * side + i], -1);
        H += J * J.transpose();
        g += here.z() * J;
      }
    const Eigen::Vector4d x = H.ldlt().solve(-g);
    if (!x.allFinite())
      return false;
    place += x.head<2>().cast<float>();
    if (x.head<2>().norm() < enough)
      break;
  }
  return (place - start).norm() <= reach;
}

/// Fits the place at one level. @return false, with nothing changed, if that is not near where it was
bool settle(const PatchQuery& query, int level, Eigen::Vector2f& place)
{
  const float scale = std::ldexp(1.f, -level);
  Template patch;
  Eigen::Vector2f fitted = place * scale;
  if (!takeTemplate(query, level, patch) || !fitPlace(patch, imageOf(query.to, level), fitted))
    return false;
  place = fitted / scale;
  return true;
}
} // namespace

bool findPatch(const PatchQuery& query, Eigen::Vector2f& place)
{
  constexpr float coarse_search = 10;       // pixels of the coarsest level: as far as a patch is itself
  constexpr int fine_search = 2;            // pixels, from one level to the next: a pixel of the last, and one more
  constexpr float least_correlation = 0.8f; // of the finest level
  constexpr float least_lead = 0.05f;       // over the second best match: repeated structure is ambiguous
  int level = 0;
  const int levels = std::min(query.from.levels.size(), query.to.levels.size());
  while (level + 1 < levels && query.search / (1 << level) > coarse_search)
    ++level;
  place = query.pixel_to;
  for (const int first = level; level >= 0; --level) {
    Template patch;
    if (!takeTemplate(query, level, patch))
      return false;
    const Image& image = query.to.levels[level];
    const float scale = 1.f / (1 << level);
    const Eigen::Vector2i at = (place * scale).array().floor().cast<int>();
    const int reach = level == first ? std::ceil(query.search * scale) : fine_search;
    const Peak peak = findPeak(patch, image, at, reach);
    if (peak.value < (level == 0 ? least_correlation : 0) || (level == first && peak.value < peak.second + least_lead))
      return false;
    place = Eigen::Vector2f(peak.x + 0.5f, peak.y + 0.5f) / scale;
    if (level == 0)
      place += Eigen::Vector2f(parabolaVertex(correlation(patch, image, peak.x - 1, peak.y), peak.value,
                                              correlation(patch, image, peak.x + 1, peak.y)),
                               parabolaVertex(correlation(patch, image, peak.x, peak.y - 1), peak.value,
                                              correlation(patch, image, peak.x, peak.y + 1)));
  }
  if (!settle(query, 0, place))
    return false;
  if (!query.from.fine.empty() && !query.to.fine.empty())
    settle(query, fine, place); // where it is too smooth for that, the place stays
  return true;
}
} // namespace fresco::texture
