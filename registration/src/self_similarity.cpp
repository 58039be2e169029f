// SPDX-License-Identifier: BSD-3-Clause
#include "self_similarity.h"
#include <algorithm>
namespace fresco {
namespace {
constexpr double least_coverage = 0.4; // of all directions: who saw less knows too little that could refute a twin
constexpr double nearest_twin = 0.5;   // of the scan's size: nearer places that look alike are one place
constexpr int twins_a_feature = 3;     // places that look like a feature's, which may be one of many
constexpr std::size_t most_matches = 2000;
constexpr float least_overlap = 0.1f;    // with itself
constexpr float most_violation = 0.08f;  // twice what a pair may have: the best of a family of poses violates less
constexpr double twin_violation = 0.004; // below, nothing speaks against a twin; noise alone causes 0.002
constexpr double twin_color = 0.6;       // correlation of colours from which two places look alike
constexpr double twin_overlap = 0.5;     // with itself: less, and the scan is laid where it saw nothing

// For each feature those of the same scan that look most alike and lie elsewhere, and apart from each other.
std::vector<Correspondence> matchToSelf(const ScanFeatures& features, float apart)
{
  struct Ranked {
    float likeness;
    Correspondence match;
  };
  std::vector<Ranked> ranked;
  const Index n = features.points.cols();
  for (Index i = 0; i < n; ++i) {
    Eigen::VectorXf likeness = features.descriptors.transpose() * features.descriptors.col(i);
    Index j = i;
    for (int k = 0; k < twins_a_feature; ++k) {
      for (Index other = 0; other < n; ++other)
        if ((features.points.col(other) - features.points.col(j)).squaredNorm() < apart * apart)
          likeness[other] = -1.f;
      if (!(likeness.maxCoeff(&j) > 0.f))
        break;
      ranked.push_back({likeness[j], {i, j}});
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& x, const Ranked& y) { return x.likeness > y.likeness; });
  std::vector<Correspondence> matches;
  for (std::size_t k = 0; k < std::min(most_matches, ranked.size()); ++k)
    matches.push_back(ranked[k].match);
  return matches;
}
} // namespace

SelfMotions findSelfMotions(const PreparedScan& scan, const ScanFeatures& features)
{
  if (scan.free_space.coverage() < least_coverage)
    return {};
  ConsensusOptions consensus;
  consensus.tolerance = 1.5f * scan.levels[1].voxel;
  consensus.size = static_cast<float>(scan.size);
  consensus.exclusive = true;
  PairAlignmentOptions options;
  options.min_overlap = least_overlap;
  options.max_violation = most_violation;
  options.refined = options.checked;
  const auto apart = static_cast<float>(nearest_twin * scan.size);
  SelfMotions motions;
  for (const PairMode& mode :
       acceptedModes(scan, scan, findConsensus(features, features, matchToSelf(features, apart), consensus), options)) {
    if (poseDistance(mode.T_a_b, Eigen::Isometry3d::Identity(), scan.size) <= apart)
      continue;
    const bool wide = mode.check.overlap > twin_overlap;
    motions.push_back(
        {mode.T_a_b, wide && mode.check.violation < twin_violation && mode.check.color.value_or(1.0) > twin_color,
         wide && mode.check.violation <= PairAlignmentOptions().max_violation ? mode.check.overlap : 0.0});
  }
  return motions;
}
} // namespace fresco
