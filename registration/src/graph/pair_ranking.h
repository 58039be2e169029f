// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/sc2_pcr.h"
namespace fresco::registration {
struct RankedPair {
  Index a = 0, b = 0;
  Index votes = 0; ///< features that agree on a pose
};

/// Sorts pairs by the votes of the best pose from their most distinctive features, most first.
void rankPairs(std::vector<RankedPair>& pairs, const std::vector<PreparedScan>& scans,
               const std::vector<ScanFeatures>& features, int threads);

/// The best pairs not yet tried, a few of each scan but the known ones; they are taken out of `pairs`.
/// @param known per scan, whether its place is known: how many look for places with it does not matter
std::vector<RankedPair> takeRound(std::vector<RankedPair>& pairs, const std::vector<char>& known);
} // namespace fresco::registration
