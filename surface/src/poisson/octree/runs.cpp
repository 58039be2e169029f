// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/runs.h"
#include <algorithm>
#include <utility>
namespace fresco::poisson {
PlacedRuns placeRuns(Exchange& exchange, const std::vector<KeyedRun>& own)
{
  Array<KeyedRun> all = gatherAll(exchange, own.data(), own.size());
  std::sort(all.begin(), all.end(), [](const KeyedRun& a, const KeyedRun& b) { return a.key < b.key; });
  PlacedRuns placed;
  for (KeyedRun& run : all)
    run.count = std::exchange(placed.count, placed.count + run.count); // from here on its place
  for (const KeyedRun& run : own) {
    const auto isBefore = [](const KeyedRun& other, std::uint64_t key) { return other.key < key; };
    placed.first.push_back(std::lower_bound(all.begin(), all.end(), run.key, isBefore)->count);
  }
  return placed;
}
} // namespace fresco::poisson
