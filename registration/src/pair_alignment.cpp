// SPDX-License-Identifier: BSD-3-Clause
#include "pair_alignment.h"
#include "joint_refinement.h"
#include <algorithm>
#include <cmath>
namespace fresco {
namespace {
constexpr double rough_scale = 0.03;       // share of violations that costs a factor e before refinement, and
constexpr double violation_scale = 0.005;  // after it: little contradiction outweighs much overlap
constexpr std::size_t checked_most = 20;   // hypotheses that are checked for violations
constexpr std::size_t refined_most = 8;    // hypotheses that are refined
constexpr double comparable_overlap = 0.3; // share of the best overlap
constexpr double color_difference = 0.3;   // of correlations: above, colours decide
constexpr double refuted_overlap = 0.2;    // the same of overlaps
constexpr double upright_cosine = 0.93;    // 21 degrees: twice the tilt of an upright scanner
constexpr Index quick_samples = 300;       // of the first overlap test

double quickOverlap(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b)
{
  const ScanLevel &level_a = a.levels.front(), &level_b = b.levels.front();
  OverlapTest test;
  test.distance = 2.f * level_a.voxel;
  test.most = quick_samples;
  test.oriented = a.oriented && b.oriented;
  return std::max(overlapShare(level_b, level_a, T_a_b.cast<float>(), test),
                  overlapShare(level_a, level_b, T_a_b.inverse().cast<float>(), test));
}

void keepBest(Hypotheses& hypotheses, std::size_t most)
{
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const auto& x, const auto& y) { return x.score > y.score; });
  hypotheses.resize(std::min(most, hypotheses.size()));
}

Eigen::Isometry3d refined(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b)
{
  JointOptions options;
  options.max_distance = 2.f * a.levels.front().voxel;
  options.samples = 1000;
  options.max_iterations = 20;
  options.last_level = 1;
  options.min_overlap = 0.f;
  options.threads = 1;
  return refineJointly({&a, &b}, {Eigen::Isometry3d::Identity(), T_a_b}, options, {}).poses[1];
}
struct PairGeometry {
  const PreparedScan &a, &b;
  double size;  // of the scans, length
  double grain; // poses nearer to each other are the same, length
};

// The hypotheses worth refining, best first.
void rankHypotheses(const PairGeometry& pair, Hypotheses& hypotheses)
{
  for (Hypothesis& hypothesis : hypotheses)
    hypothesis.score = quickOverlap(pair.a, pair.b, hypothesis.T_a_b);
  keepBest(hypotheses, checked_most);
  for (Hypothesis& hypothesis : hypotheses) {
    const PairCheck check = checkPair(pair.a, pair.b, hypothesis.T_a_b, 0);
    hypothesis.score = check.overlap * std::exp(-check.violation / rough_scale);
  }
  keepBest(hypotheses, checked_most);
}

PairMode refinedMode(const PairGeometry& pair, const Hypothesis& hypothesis)
{
  PairMode mode;
  mode.T_a_b = refined(pair.a, pair.b, hypothesis.T_a_b);
  mode.votes = hypothesis.votes;
  mode.check = checkPair(pair.a, pair.b, mode.T_a_b, check_level);
  // Without free space on both sides, features are the only other witnesses.
  const bool blind = pair.a.free_space.empty() || pair.b.free_space.empty();
  const double trust = blind ? std::min(1.0, static_cast<double>(mode.votes) / static_cast<double>(many_votes)) : 1.0;
  mode.support = trust * mode.check.overlap;
  mode.score = trust * alignmentScore(mode.check);
  return mode;
}

// Distinct refined hypotheses, checked at the finest level.
PairModes refineHypotheses(const PairGeometry& pair, const Hypotheses& hypotheses)
{
  PairModes modes;
  for (const Hypothesis& hypothesis : hypotheses) {
    const auto known = [&](const Eigen::Isometry3d& T, double factor) {
      return std::any_of(modes.begin(), modes.end(), [&](const PairMode& mode) {
        return poseDistance(mode.T_a_b, T, pair.size) < factor * pair.grain;
      });
    };
    if (modes.size() >= refined_most)
      break;
    if (known(hypothesis.T_a_b, 3.0))
      continue;
    const PairMode mode = refinedMode(pair, hypothesis);
    if (!known(mode.T_a_b, 1.0))
      modes.push_back(mode);
  }
  return modes;
}
} // namespace

double alignmentScore(const PairCheck& check)
{
  const double color = check.color ? std::max(0.1, *check.color) : 1.0;
  return check.overlap * color * std::exp(-check.violation / violation_scale);
}

bool comparable(const PairMode& best, const PairMode& other)
{
  const PairCheck &first = best.check, &second = other.check;
  if (first.color && second.color && std::abs(*first.color - *second.color) > color_difference)
    return false;
  return second.violation <= std::max(2.0 * first.violation, first.violation + violation_scale) &&
         other.support > comparable_overlap * best.support;
}

PairAlignment alignPair(const PreparedScan& a, const PreparedScan& b, const ScanFeatures& features_a,
                        const ScanFeatures& features_b, const PairAlignmentOptions& options)
{
  const float voxel = a.levels[1].voxel;
  const PairGeometry pair{a, b, std::sqrt(a.size * b.size), 4.0 * voxel};
  ConsensusOptions consensus;
  consensus.tolerance = 1.5f * voxel;
  consensus.size = static_cast<float>(pair.size);
  Hypotheses hypotheses =
      findConsensus(features_a, features_b, matchFeatures(features_a, features_b, options.matches), consensus);
  if (options.upright)
    hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(),
                                    [](const Hypothesis& h) { return h.T_a_b.linear()(2, 2) < upright_cosine; }),
                     hypotheses.end());
  const Hypotheses popular(hypotheses.begin(), hypotheses.begin() + (hypotheses.empty() ? 0 : 1));
  rankHypotheses(pair, hypotheses);

  PairAlignment alignment;
  for (const PairMode& mode : refineHypotheses(pair, hypotheses))
    if (mode.check.overlap >= options.min_overlap && mode.check.violation <= options.max_violation)
      alignment.modes.push_back(mode);
  std::stable_sort(alignment.modes.begin(), alignment.modes.end(),
                   [](const PairMode& x, const PairMode& y) { return x.score > y.score; });
  for (std::size_t k = 1; k < alignment.modes.size(); ++k)
    alignment.ambiguous = alignment.ambiguous || comparable(alignment.modes[0], alignment.modes[k]);
  if (alignment.modes.empty() && !popular.empty() && popular[0].votes >= many_votes) {
    const PairMode mode = refinedMode(pair, popular[0]);
    if (mode.check.violation > options.max_violation && mode.check.overlap >= refuted_overlap)
      alignment.refuted = {mode};
  }
  return alignment;
}
} // namespace fresco
