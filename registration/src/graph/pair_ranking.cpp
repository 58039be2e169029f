// SPDX-License-Identifier: BSD-3-Clause
#include "graph/pair_ranking.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::registration {
namespace {
ScanFeatures mostDistinctive(const ScanFeatures& features)
{
  constexpr Index quick_features = 300; // a quarter of all: matching and SC2-PCR then take a sixteenth of the time
  const Index n = std::min(quick_features, features.points.cols());
  return {features.points.leftCols(n), features.normals.leftCols(n), features.descriptors.leftCols(n), {}};
}
} // namespace

void rankPairs(std::vector<RankedPair>& pairs, const std::vector<PreparedScan>& scans,
               const std::vector<ScanFeatures>& features, int threads)
{
  std::vector<ScanFeatures> few;
  for (const ScanFeatures& all : features)
    few.push_back(mostDistinctive(all));
  parallelFor(
      pairs.size(), threads,
      [&](Index k) {
        RankedPair& pair = pairs[k];
        const ScanFeatures &a = few[pair.a], &b = few[pair.b];
        Sc2PcrOptions options;
        options.tolerance = 1.5f * scans[pair.a].levels[1].voxel;
        options.size = scans[pair.a].size;
        options.most = 1;
        const PoseHypotheses best = runSc2Pcr(a, b, matchFeatures(a, b, 400), options);
        pair.votes = best.empty() ? 0 : best[0].votes;
      },
      1);
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& x, const auto& y) { return x.votes > y.votes; });
}

std::vector<RankedPair> takeRound(std::vector<RankedPair>& pairs, const std::vector<char>& known)
{
  constexpr Index partners_a_round = 4; // of each scan: two to either side of a chain of scans
  std::vector<Index> taken(known.size(), 0);
  for (std::size_t i = 0; i < known.size(); ++i)
    taken[i] = known[i] ? partners_a_round : 0;
  std::vector<RankedPair> round, rest;
  for (const RankedPair& pair : pairs) {
    Index &a = taken[pair.a], &b = taken[pair.b];
    const bool take = std::min(a, b) < partners_a_round;
    (take ? round : rest).push_back(pair);
    a += take ? 1 : 0;
    b += take ? 1 : 0;
  }
  pairs = std::move(rest);
  return round;
}
} // namespace fresco::registration
