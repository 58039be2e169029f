// SPDX-License-Identifier: BSD-3-Clause
#include "pair/place_likeness.h"
#include "pair/feature_matching.h"
#include "pair/plane_matching.h"
#include <algorithm>
#include <cmath>
namespace fresco::registration {
namespace {
constexpr Index few_features = 300; // a quarter of all: matching and SC2-PCR then take a sixteenth of the time
constexpr int overlap_level = 1;    // coarser than check_level, as poses are: 10 cm where planes gave them

ScanFeatures mostDistinctive(const ScanFeatures& features)
{
  const Index n = std::min(few_features, features.points.cols());
  return {features.points.leftCols(n), features.normals.leftCols(n), features.descriptors.leftCols(n), features.planes};
}

double overlap(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b)
{
  const ScanLevel &level_a = a.levels[overlap_level], &level_b = b.levels[overlap_level];
  OverlapTest test;
  test.distance = 2.f * std::max(level_a.voxel, level_b.voxel);
  test.most = 150; // the share is known to 4 %
  test.oriented = a.oriented && b.oriented;
  return std::max(overlapShare(level_b, level_a, T_a_b.cast<float>(), test),
                  overlapShare(level_a, level_b, T_a_b.inverse().cast<float>(), test));
}

PoseHypotheses likelyPoses(const PlaceSample& a, const PlaceSample& b, bool upright)
{
  constexpr std::size_t most_by_planes = 50, most_by_features = 20, matches = 400;
  Sc2PcrOptions options;
  options.tolerance = 1.5f * a.scan.levels[1].voxel;
  options.size = a.scan.size;
  options.most = most_by_features;
  PoseHypotheses poses = runSc2Pcr(a.features, b.features, matchFeatures(a.features, b.features, matches), options);
  if (!a.scan.free_space.empty() && !b.scan.free_space.empty())
    for (const PoseHypothesis& pose : matchPlanes(a.features.planes, b.features.planes, most_by_planes))
      poses.push_back(pose);
  if (upright)
    keepUpright(poses);
  return poses;
}
} // namespace

PlaceSample::PlaceSample(const PreparedScan& prepared, const ScanFeatures& all)
    : scan(prepared), features(mostDistinctive(all))
{}

double roughLikeness(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b, double least)
{
  constexpr double likeness_scale = 0.02; // of violations, as violation_scale, for poses that are not refined
  const double discount = std::exp(-sampledViolation(a, b, T_a_b) / likeness_scale);
  return discount > least ? discount * overlap(a, b, T_a_b) : 0.0;
}

double placeLikeness(const PlaceSample& a, const PlaceSample& b, bool upright)
{
  double best = 0.0;
  for (const PoseHypothesis& pose : likelyPoses(a, b, upright))
    best = std::max(best, roughLikeness(a.scan, b.scan, pose.T_a_b, best));
  return best;
}
} // namespace fresco::registration
