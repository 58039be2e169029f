// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_ranking.h"
#include "pair/feature_matching.h"
#include "pair/place_likeness.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::registration {
namespace {
// Of the best pose.
double agreeingFeatures(const PlaceSample& a, const PlaceSample& b)
{
  Sc2PcrOptions options;
  options.tolerance = 1.5f * a.scan.levels[1].voxel;
  options.size = a.scan.size;
  options.most = 1;
  const PoseHypotheses best = runSc2Pcr(a.features, b.features, matchFeatures(a.features, b.features, 400), options);
  return best.empty() ? 0.0 : best[0].votes;
}

void sortByLikeness(std::vector<RankedPair>& pairs)
{
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& x, const auto& y) { return x.likeness > y.likeness; });
}
} // namespace

void rankPairs(std::vector<RankedPair>& pairs, const std::vector<PreparedScan>& scans,
               const std::vector<ScanFeatures>& features, const RankingOptions& options)
{
  std::vector<PlaceSample> samples;
  for (std::size_t k = 0; k < scans.size(); ++k)
    samples.emplace_back(scans[k], features[k]);
  parallelFor(
      pairs.size(), options.threads,
      [&](Index k) {
        RankedPair& pair = pairs[k];
        const PlaceSample &a = samples[pair.a], &b = samples[pair.b];
        pair.likeness = options.by_place ? placeLikeness(a, b, options.upright) : agreeingFeatures(a, b);
      },
      1);
  sortByLikeness(pairs);
}

std::vector<RankedPair> firstPartners(std::vector<RankedPair> pairs, Index scan_count, Index partners)
{
  sortByLikeness(pairs);
  std::vector<Index> better(scan_count, 0); // pairs of a scan so far
  std::vector<RankedPair> first;
  for (const RankedPair& pair : pairs) {
    if (std::min(better[pair.a], better[pair.b]) < partners)
      first.push_back(pair);
    ++better[pair.a];
    ++better[pair.b];
  }
  return first;
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
