// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/filters/core/local_sampling.h>
#include <fresco/search/batch_knn.h>
namespace fresco {
namespace {
/// A thousandth of the smallest positive value in place of zeros.
Eigen::VectorXf withoutZeros(const Eigen::VectorXf& areas)
{
  if (areas.size() == 0)
    return areas;
  const float infinity = std::numeric_limits<float>::infinity();
  const float smallest = (areas.array() > 0).select(areas, infinity).minCoeff();
  return areas.cwiseMax((smallest < infinity ? smallest : 1.f) / 1000);
}

/// @param near positions by distance, the point itself included
float areaOf(const PointTree& tree, Index i, const int* near, Index count)
{
  const Index others = count - 1;
  const float squared = others > 0 ? (tree.point(near[count - 1]) - tree.point(i)).squaredNorm() : 0.f;
  return others > 0 && std::isfinite(squared) ? float(pi) * squared / others : 0.f;
}
} // namespace

Eigen::VectorXf sampleAreas(const PointTree& tree, int k, int threads)
{
  require(k >= 1, "sample areas: k ", k, " is below 1");
  Eigen::VectorXf areas(tree.size());
  forNearest(tree, k + 1, threads,
             [&](Index i, const int* found, Index count) { areas[i] = areaOf(tree, i, found, count); });
  return withoutZeros(areas);
}

Eigen::VectorXf sampleAreas(const PointTree& tree, const NeighborLists& lists, int threads)
{
  require(lists.size() == tree.size(), "sample areas: ", lists.size(), " lists of ", tree.size(), " points");
  Eigen::VectorXf areas(tree.size());
  parallelFor(tree.size(), threads, [&](Index i) { areas[i] = areaOf(tree, i, lists.first(i), lists.count(i)); });
  return withoutZeros(areas);
}
} // namespace fresco
