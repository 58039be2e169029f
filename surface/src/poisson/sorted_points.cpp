// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/sorted_points.h"
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

SortedPoints::SortedPoints(const PointSet& set, Index begin, int depth, const Keys& keys)
    : set_(set), begin_(begin), index_bits_(indexBits(depth)), keys_(keys)
{}

/// Unusable points get a code behind all others.
SortedPoints::Keys SortedStream::sortedKeys(const PointSet& set, Index begin, Index end) const
{
  const int depth = extent_.cube.depth, index_bits = indexBits(depth);
  const std::uint64_t unusable = std::uint64_t(1) << 3 * depth;
  SortedPoints::Keys keys(end - begin);
  const Index usable = parallelSum(end - begin, threads_, Index(0), [&](Index k) {
    const bool takes_part = extent_.isUsable(set, begin + k);
    keys[k] = k;
    keys[k] |= (takes_part ? cellCode(toCells(set, begin + k, extent_).cast<float>(), depth) : unusable) << index_bits;
    return takes_part ? 1 : 0;
  });
  sortBits(keys, index_bits, 3 * depth + (usable < end - begin ? 1 : 0), threads_);
  keys.resize(usable);
  return keys;
}

void SortedStream::forEachPiece(const std::function<void(const SortedPoints&)>& receive)
{
  const Index most = Index(1) << indexBits(extent_.cube.depth);
  SortedPoints::Keys keys = std::move(only_);
  Index pieces = 0;
  points_.read([&](const PointSet& set) {
    for (Index begin = 0; begin < set.size(); begin += most) {
      if (keys.empty() || pieces > 0)
        keys = sortedKeys(set, begin, std::min(begin + most, set.size()));
      ++pieces;
      receive(SortedPoints(set, begin, extent_.cube.depth, keys));
    }
  });
  if (pieces == 1)
    only_ = std::move(keys);
}
} // namespace fresco::poisson
