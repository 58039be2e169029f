// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/point_sketch.h"
#include "poisson/octree/bytes.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <cstring>
#include <fresco/core/parallel.h>
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

void PointSketch::add(const PointSet& set, const std::function<bool(Index)>& takes, int threads)
{
  constexpr Index piece = 1 << 18; // piece by piece, so that few come that do not stay
  std::vector<std::vector<Entry>> found(piece / chunk_size);
  for (Index first = 0; first < set.size(); first += piece) {
    const auto look = [&](Index begin, Index end) {
      std::vector<Entry>& entries = found[begin / chunk_size];
      entries.clear();
      for (Index i = first + begin; i < first + end; ++i)
        if (const std::uint64_t hash = hashOf(set.points.col(i)); hash <= highest_ && takes(i))
          entries.push_back({hash, set.points.col(i)});
    };
    const Index count = std::min(piece, set.size() - first);
    parallelRanges(count, threads, look, chunk_size);
    for (Index begin = 0; begin < count; begin += chunk_size)
      entries_.insert(entries_.end(), found[begin / chunk_size].begin(), found[begin / chunk_size].end());
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

void PointSketch::share(Exchange& exchange)
{
  if (exchange.size() == 1)
    return;
  if (entries_.size() > most_entries)
    keepLowest();
  Bytes message;
  append(message, entries_.data(), entries_.size());
  entries_.clear();
  for (const Bytes& part : exchange.gatherAll(std::move(message))) {
    appendTo(entries_, part);
    if (entries_.size() > most_entries)
      keepLowest();
  }
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
