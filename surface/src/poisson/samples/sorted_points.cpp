// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/sorted_points.h"
#include "poisson/octree/radix_sort.h"
#include <algorithm>
#include <fresco/core/morton.h>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
int indexBits(int depth)
{
  constexpr int most_bits = 21;               // 32 MB to sort
  return std::min(most_bits, 63 - 3 * depth); // a bit is left to tell unusable points
}

/// Rounded to float first, as the means are: a mean of such points is in their cell.
std::uint64_t cellCode(const Eigen::Vector3f& cell, int depth)
{
  const float last = (1 << depth) - 1;
  const Eigen::Vector3i c = cell.cwiseMax(0.f).cwiseMin(last).cast<int>();
  return mortonCode(c.x(), c.y(), c.z());
}
} // namespace

/// Unusable points get a code behind all others, and are cut off.
SortedPoints::SortedPoints(const PointSet& set, Index begin, Index end, const Extent& extent, int threads)
    : set_(set), begin_(begin), index_bits_(indexBits(extent.cube.depth)), keys_(end - begin)
{
  const int depth = extent.cube.depth;
  const std::uint64_t unusable = std::uint64_t(1) << 3 * depth;
  const Index usable = parallelSum(end - begin, threads, Index(0), [&](Index k) {
    const bool takes_part = extent.isUsable(set, begin + k);
    const std::uint64_t code = takes_part ? cellCode(toCells(set, begin + k, extent).cast<float>(), depth) : unusable;
    keys_[k] = code << index_bits_ | std::uint64_t(k);
    return takes_part ? 1 : 0;
  });
  sortBits(keys_, index_bits_, 3 * depth + (usable < end - begin ? 1 : 0), threads);
  keys_.resize(usable);
}

void forEachPiece(const PointStream& points, const Extent& extent, int threads,
                  const std::function<void(const SortedPoints&)>& receive)
{
  const Index most = Index(1) << indexBits(extent.cube.depth);
  points.read([&](const PointSet& set) {
    for (Index begin = 0; begin < set.size(); begin += most)
      receive(SortedPoints(set, begin, std::min(begin + most, set.size()), extent, threads));
  });
}

bool isOnePiece(const Extent& extent)
{
  return extent.windows == 1 && extent.all <= Index(1) << indexBits(extent.cube.depth);
}
} // namespace fresco::poisson
