// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_ranking.h"
#include "pair/feature_matching.h"
#include "pair/plane_matching.h"
#include "scan/lists.h"
#include <cmath>
namespace fresco::registration {
namespace {
ScanFeatures mostDistinctive(const ScanFeatures& features)
{
  constexpr Index few = 300; // a quarter of all: matching and SC2-PCR then take a sixteenth of the time
  const Index n = std::min(few, features.points.cols());
  return {features.points.leftCols(n), features.normals.leftCols(n), features.descriptors.leftCols(n), features.planes};
}

PoseHypotheses posesByFeatures(const DescribedScan& a, const DescribedScan& b, std::size_t most)
{
  constexpr std::size_t matches = 400;
  Sc2PcrOptions options;
  options.tolerance = 1.5f * a.scan.levels[1].voxel;
  options.size = a.scan.size;
  options.most = most;
  return runSc2Pcr(a.features, b.features, matchFeatures(a.features, b.features, matches), options);
}

// Of the best pose.
double agreeingFeatures(const DescribedScan& a, const DescribedScan& b)
{
  const PoseHypotheses best = posesByFeatures(a, b, 1);
  return best.empty() ? 0.0 : best[0].votes;
}

// How well two scans fit at best of some poses that are not refined, 0..1: the overlap, discounted by the share of points
// in space that the other scan saw through, both of few samples.
double bestLikeness(const PreparedScan& a, const PreparedScan& b, const PoseHypotheses& poses)
{
  constexpr double likeness_scale = 0.02; // of violations, as violation_scale, for poses that are not refined
  // The share is known to 4 %; coarser than check_level, as poses are: 10 cm where planes gave them.
  constexpr SampledLevel few{1, 150};
  double best = 0.0;
  for (const PoseHypothesis& pose : poses) {
    const double discount = std::exp(-sampledViolation(a, b, pose.T_a_b) / likeness_scale);
    if (discount > best) // the overlap is at most 1
      best = std::max(best, discount * pairOverlap(a, b, pose.T_a_b, few));
  }
  return best;
}

// In a hundredth of the time that alignPair() takes: the poses that most planes and features agree on are tried.
double placeLikeness(const DescribedScan& a, const DescribedScan& b, bool upright)
{
  constexpr std::size_t most_by_planes = 50, most_by_features = 20;
  PoseHypotheses poses = posesByFeatures(a, b, most_by_features);
  if (!a.scan.free_space.empty() && !b.scan.free_space.empty())
    for (const PoseHypothesis& pose : matchPlanes(a.features.planes, b.features.planes, most_by_planes))
      poses.push_back(pose);
  if (upright)
    keepUpright(poses);
  return bestLikeness(a.scan, b.scan, poses);
}
} // namespace

double planLikeness(const PlannedScan& a, const PlannedScan& b)
{
  constexpr std::size_t most_rough = 8; // of pairs that overlap by 0.25, three of four are first among them
  return bestLikeness(a.scan, b.scan, matchPlans(a.plan, b.plan, most_rough));
}

void rankPairs(std::vector<RankedPair>& pairs, const std::vector<PreparedScan>& scans,
               const std::vector<ScanFeatures>& features, const RankingOptions& options)
{
  std::vector<ScanFeatures> few;
  std::transform(features.begin(), features.end(), std::back_inserter(few), mostDistinctive);
  forEachTask(pairs.size(), options.threads, [&](Index k) {
    const DescribedScan a{scans[pairs[k].a], few[pairs[k].a]}, b{scans[pairs[k].b], few[pairs[k].b]};
    pairs[k].likeness = options.by_place ? placeLikeness(a, b, options.upright) : agreeingFeatures(a, b);
  });
  sortFalling(pairs, &RankedPair::likeness);
}

std::vector<RankedPair> firstPartners(std::vector<RankedPair> pairs, Index scan_count, Index partners)
{
  sortFalling(pairs, &RankedPair::likeness);
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
