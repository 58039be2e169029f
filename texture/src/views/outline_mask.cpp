// SPDX-License-Identifier: BSD-3-Clause
#include "views/outline_mask.h"
#include "photographs/grid.h"
#include <algorithm>
#include <cmath>
namespace fresco::texture {
namespace {
/// Inverse depth along a row or column of cells; over a plane it is linear.
struct Line {
  const DepthMap& inverses; ///< 1 / depth
  int x, y, dx, dy;

  float inverse(int k) const
  {
    const int i = x + k * dx, j = y + k * dy;
    return i < 0 || j < 0 || i >= inverses.width || j >= inverses.height ? NAN : inverses.at(i, j);
  }

  /// Whether depth jumps by more than `step`, and by more than the slope of both sides explains, from cell 0 to cell 1.
  bool jumps(float step) const
  {
    const float a = inverse(0), b = inverse(1), jump = std::abs(b - a);
    const float nearer = std::max(a, b), farther = std::min(a, b);
    if (!(jump > step * nearer * farther))
      return false;
    const float before = inverse(-1), after = inverse(2);
    const float slopes =
        std::max(std::isnan(before) ? 0.f : std::abs(a - before), std::isnan(after) ? 0.f : std::abs(after - b));
    const float from_before = std::isnan(before) ? jump : std::abs(b - 2 * a + before),
                from_after = std::isnan(after) ? jump : std::abs(a - 2 * b + after);
    const float unexplained = std::min(from_before, from_after);
    return unexplained > step * nearer * farther && (unexplained > 1.5f * slopes || isThin(step));
  }

  /// Whether one of the two cells stands alone before both of its neighbours.
  bool isThin(float step) const
  {
    const auto alone = [&](int k) {
      const float here = inverse(k), beside = std::max(inverse(k - 1), inverse(k + 1));
      return here - beside > step * here * beside;
    };
    return alone(0) || alone(1);
  }
};
} // namespace

OutlineMask::OutlineMask(const DepthMap& map, float reach, float step)
    : width_(map.width), height_(map.height), per_pixel_(1 / map.step), near_(cellCount(map.width, map.height), false)
{
  const int radius = std::ceil(reach / map.step);
  DepthMap inverses = map;
  for (float& depth : inverses.depth)
    depth = 1 / depth;
  std::vector<float> nearest(near_.size(), 0); // of several outlines
  const auto spread = [&](const Line& line) {
    const float between = 0.5f * (line.inverse(0) + line.inverse(1));
    for (int y = std::max(0, line.y + line.dy - radius); y <= std::min(height_ - 1, line.y + radius); ++y)
      for (int x = std::max(0, line.x + line.dx - radius); x <= std::min(width_ - 1, line.x + radius); ++x)
        if (float& here = nearest[cellAt(x, y, width_)]; here < between)
          here = between;
  };
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      for (int along = 0; along < 2; ++along)
        if (const Line line{inverses, x, y, 1 - along, along};
            x + line.dx < width_ && y + line.dy < height_ && line.jumps(step))
          spread(line);
  for (std::size_t cell = 0; cell < nearest.size(); ++cell)
    if ((near_[cell] = nearest[cell] > 0))
      between_.emplace_back(cell, nearest[cell]);
  between_.shrink_to_fit();
}

Eigen::Vector2i OutlineMask::cellUnder(const Eigen::Vector2f& pixel) const
{
  const Eigen::Array2f cell = (pixel.array() * per_pixel_).max(0.f).min(1e6f);
  return {std::min<int>(cell.x(), width_ - 1), std::min<int>(cell.y(), height_ - 1)};
}

bool OutlineMask::holds(const Eigen::Vector2f& pixel, float inverse_depth) const
{
  if (near_.empty())
    return false;
  const Eigen::Vector2i at = cellUnder(pixel);
  const std::uint32_t cell = cellAt(at.x(), at.y(), width_);
  if (!near_[cell])
    return false;
  const auto found = std::lower_bound(between_.begin(), between_.end(), cell,
                                      [](const auto& entry, std::uint32_t wanted) { return entry.first < wanted; });
  return inverse_depth < found->second;
}

bool OutlineMask::touches(const Eigen::Vector2f& low, const Eigen::Vector2f& high) const
{
  if (near_.empty())
    return false;
  const Eigen::Vector2i first = cellUnder(low), last = cellUnder(high);
  for (int y = first.y(); y <= last.y(); ++y)
    for (int x = first.x(); x <= last.x(); ++x)
      if (near_[cellAt(x, y, width_)])
        return true;
  return false;
}
} // namespace fresco::texture
