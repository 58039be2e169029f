// SPDX-License-Identifier: BSD-3-Clause
#include "scan/point_blocks.h"
#include <algorithm>
#include <numeric>
namespace fresco::registration {
namespace {
using Order = std::vector<std::int32_t>;

Eigen::AlignedBox3f boxOf(const Points& points, Order::const_iterator begin, Order::const_iterator end)
{
  Eigen::AlignedBox3f box;
  for (auto i = begin; i != end; ++i)
    box.extend(Eigen::Vector3f(points.col(*i)));
  return box;
}

// Halves them along their longest side until each part is a block; all blocks but the last are full.
void split(const Points& points, Order::iterator begin, Order::iterator end, std::ptrdiff_t most)
{
  const std::ptrdiff_t blocks = (end - begin + most - 1) / most;
  if (blocks < 2)
    return;
  Index axis = 0;
  boxOf(points, begin, end).sizes().maxCoeff(&axis);
  const auto middle = begin + blocks / 2 * most;
  std::nth_element(begin, middle, end, [&](auto i, auto k) { return points(axis, i) < points(axis, k); });
  split(points, begin, middle, most);
  split(points, middle, end, most);
}
} // namespace

PointBlocks::PointBlocks(const Points& points) : order_(points.cols())
{
  std::iota(order_.begin(), order_.end(), 0);
  split(points, order_.begin(), order_.end(), most);
  for (std::size_t from = 0; from < order_.size(); from += most) {
    const auto begin = order_.begin() + from, end = order_.begin() + std::min(order_.size(), from + most);
    const Eigen::Vector3f center = boxOf(points, begin, end).center();
    float radius = 0.f;
    for (auto i = begin; i != end; ++i)
      radius = std::max(radius, (points.col(*i) - center).norm());
    spheres_.push_back({center, radius});
  }
}
} // namespace fresco::registration
