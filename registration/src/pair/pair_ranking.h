// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
namespace fresco::registration {
struct RankedPair {
  Index a = 0, b = 0;
  double likeness = 0.0; ///< how likely both scans saw the same place; larger is likelier
};

struct RankingOptions {
  bool by_place = false; ///< by how well they fit at the best of some poses; else by the features that agree on a pose
  bool upright = false;  ///< whether all scanners stood upright
  int threads = 0;
};

/// Sorts pairs by likeness, largest first.
void rankPairs(std::vector<RankedPair>& pairs, const std::vector<PreparedScan>& scans,
               const std::vector<ScanFeatures>& features, const RankingOptions& options);

/// How well two scans fit at best, 0..1, in a fiftieth of the time that alignByPlans() takes: the poses that their floor
/// plans agree on are tried as they are.
double planLikeness(const PlannedScan& a, const PlannedScan& b);

/// Pairs that are among the `partners` likeliest of either of their scans, likeliest first.
std::vector<RankedPair> firstPartners(std::vector<RankedPair> pairs, Index scan_count, Index partners);

/// The best pairs not yet tried, a few of each scan but the known ones; they are taken out of `pairs`.
/// @param known per scan, whether its place is known: how many look for places with it does not matter
std::vector<RankedPair> takeRound(std::vector<RankedPair>& pairs, const std::vector<char>& known);
} // namespace fresco::registration
