// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/sorted_points.h"
#include "poisson/octree/radix_sort.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <fresco/core/morton.h>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
int indexBits(int depth)
{
  constexpr int most_bits = 22; // 70 MB to sort, and pieces of a dense cloud have several points a cell
  return std::min(most_bits, 64 - 3 * depth);
}

/// Rounded to float first, as the means are: a mean of such points is in their cell.
std::uint64_t cellCode(const Eigen::Vector3f& cell, int depth)
{
  const float last = (1 << depth) - 1;
  const Eigen::Vector3i c = cell.cwiseMax(0.f).cwiseMin(last).cast<int>();
  return mortonCode(c.x(), c.y(), c.z());
}
} // namespace

Index SortedPoints::mostPoints(int depth) { return Index(1) << indexBits(depth); }

SortedPoints::SortedPoints(const PointSet& set, Index begin, Index end, const Extent& extent, int threads)
    : set_(&set), begin_(begin), index_bits_(indexBits(extent.cube.depth))
{
  const Array<std::uint32_t> usable =
      selectIndices(end - begin, threads, [&](Index i) { return extent.isUsable(set, begin + i); });
  keys_.resize(usable.size());
  parallelFor(usable.size(), threads, [&](Index k) {
    const Eigen::Vector3f cell = toCells(set, begin + usable[k], extent.cube).cast<float>();
    keys_[k] = cellCode(cell, extent.cube.depth) << index_bits_ | usable[k];
  });
  sortBits(keys_, index_bits_, 3 * extent.cube.depth, threads);
}

void forEachPiece(const PointStream& points, const Extent& extent, int threads,
                  const std::function<void(const SortedPoints&)>& receive)
{
  const Index most = SortedPoints::mostPoints(extent.cube.depth);
  points.read([&](const PointSet& set) {
    for (Index begin = 0; begin < set.size(); begin += most)
      if (const SortedPoints sorted(set, begin, std::min(begin + most, set.size()), extent, threads); sorted.size() > 0)
        receive(sorted);
  });
}
} // namespace fresco::poisson
