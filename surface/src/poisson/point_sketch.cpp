// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/point_sketch.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <cstring>
#include <tuple>
namespace fresco::poisson {
namespace {
constexpr std::size_t most_entries = 1 << 17; // 131 of them lie beyond a quantile of a thousandth

/// Finaliser of MurmurHash3 (Appleby, public domain) over the bits of each coordinate in turn.
std::uint64_t hashOf(const Eigen::Vector3f& position)
{
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &position[axis], sizeof(bits));
    hash ^= bits;
    hash = (hash ^ hash >> 33) * 0xff51afd7ed558ccdU;
    hash = (hash ^ hash >> 33) * 0xc4ceb9fe1a85ec53U;
    hash ^= hash >> 33;
  }
  return hash;
}
} // namespace

void PointSketch::add(const PointSet& set, const Array<std::uint32_t>& points, int threads)
{
  constexpr Index piece = 1 << 18; // so that few entries come at a time that do not stay
  for (Index begin = 0; begin < Index(points.size()); begin += piece) {
    const Index count = std::min<Index>(piece, points.size() - begin);
    const auto position = [&](Index i) -> Eigen::Vector3f { return set.points.col(points[begin + i]); };
    for (const std::uint32_t i :
         selectIndices(count, threads, [&](Index i) { return hashOf(position(i)) <= highest_; }))
      entries_.push_back({hashOf(position(i)), position(i)});
    if (entries_.size() > 2 * most_entries)
      keepLowest();
  }
}

void PointSketch::keepLowest()
{
  const auto less = [](const Entry& a, const Entry& b) {
    return std::tie(a.hash, a.position[0], a.position[1], a.position[2]) <
           std::tie(b.hash, b.position[0], b.position[1], b.position[2]);
  };
  std::nth_element(entries_.begin(), entries_.begin() + (most_entries - 1), entries_.end(), less);
  entries_.resize(most_entries);
  highest_ = entries_.back().hash;
}

std::vector<float> PointSketch::coordinates(int axis) const
{
  PointSketch lowest(*this);
  if (entries_.size() > most_entries)
    lowest.keepLowest();
  std::vector<float> values;
  for (const Entry& entry : lowest.entries_)
    values.push_back(entry.position[axis]);
  return values;
}
} // namespace fresco::poisson
