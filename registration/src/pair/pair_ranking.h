// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_features.h"
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::registration {
struct RankedPair {
  Index a = 0, b = 0;
  double likeness = 0.0; ///< how likely both scans saw the same place; larger is likelier
};

struct RankingOptions {
  bool by_place = false; ///< by placeLikeness(); else by the features that agree on a pose
  bool upright = false;  ///< whether all scanners stood upright
  int threads = 0;
};

/// Sorts pairs by likeness, largest first.
void rankPairs(std::vector<RankedPair>& pairs, const std::vector<PreparedScan>& scans,
               const std::vector<ScanFeatures>& features, const RankingOptions& options);

/// Pairs that are among the `partners` likeliest of either of their scans, likeliest first.
std::vector<RankedPair> firstPartners(std::vector<RankedPair> pairs, Index scan_count, Index partners);

/// The best pairs not yet tried, a few of each scan but the known ones; they are taken out of `pairs`.
/// @param known per scan, whether its place is known: how many look for places with it does not matter
std::vector<RankedPair> takeRound(std::vector<RankedPair>& pairs, const std::vector<char>& known);
} // namespace fresco::registration
