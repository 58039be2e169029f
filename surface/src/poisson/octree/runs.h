// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/bytes.h"
#include <fresco/core/types.h>
#include <vector>
namespace fresco::poisson {
/// Consecutive elements of an array that is divided among ranks. The keys of all ranks tell the order of the runs.
struct KeyedRun {
  std::uint64_t key;
  Index count;
};

/// Appends `count` elements with a key no lower than the last one's.
inline void addToRuns(std::vector<KeyedRun>& runs, std::uint64_t key, Index count)
{
  if (count == 0)
    return;
  if (!runs.empty() && runs.back().key == key)
    runs.back().count += count;
  else
    runs.push_back({key, count});
}

/// Where runs begin in the whole.
struct PlacedRuns {
  std::vector<Index> first; ///< by own run
  Index count = 0;          ///< of all elements
};
PlacedRuns placeRuns(Exchange& exchange, const std::vector<KeyedRun>& own);
} // namespace fresco::poisson
