// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
#include <fresco/filters/core/local_sampling.h>
namespace fresco {
namespace {
constexpr float pi = 3.14159265f;

float smallestPositive(const Eigen::VectorXf& values)
{
  float smallest = std::numeric_limits<float>::infinity();
  for (const float value : values)
    if (value > 0)
      smallest = std::min(smallest, value);
  return std::isfinite(smallest) ? smallest : 1.f;
}
} // namespace

Eigen::VectorXf sampleAreas(const PointTree& tree, int k, int threads)
{
  require(k >= 1, "sample areas: k ", k, " is below 1");
  return sampleAreas(tree, nearestLists(tree, k + 1, threads), threads);
}

Eigen::VectorXf sampleAreas(const PointTree& tree, const NeighborLists& lists, int threads)
{
  require(lists.size() == tree.size(), "sample areas: ", lists.size(), " lists of ", tree.size(), " points");
  Eigen::VectorXf areas(tree.size());
  parallelFor(tree.size(), threads, [&](Index i) {
    const Index others = lists.count(i) - 1;
    const float squared = others > 0 ? (tree.point(*(lists.last(i) - 1)) - tree.point(i)).squaredNorm() : 0.f;
    areas[i] = others > 0 && std::isfinite(squared) ? pi * squared / static_cast<float>(others) : 0.f;
  });
  const float least = smallestPositive(areas) / 1000;
  return areas.cwiseMax(least);
}
} // namespace fresco
