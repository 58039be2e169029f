// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_alignment.h"
#include "refinement/joint_refinement.h"
#include <algorithm>
#include <cmath>
namespace fresco::registration {
namespace {
constexpr double rough_scale = 0.03;       // share of violations that costs a factor e before refinement, and
constexpr double violation_scale = 0.005;  // after it: little contradiction outweighs much overlap
constexpr double comparable_overlap = 0.3; // share of the best overlap
constexpr double color_difference = 0.3;   // of correlations: above, colours decide
constexpr double clear_violation = 0.002;  // difference of violations that mixed points do not cause
constexpr std::size_t twinned_most = 3;    // modes, the best, whose alternatives are tried
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

PairGeometry geometryOf(const PreparedScan& a, const PreparedScan& b)
{
  return {a, b, std::sqrt(a.size * b.size), 4.0 * a.levels[1].voxel};
}

// The hypotheses worth refining, best first.
void rankHypotheses(const PairGeometry& pair, std::size_t most, Hypotheses& hypotheses)
{
  for (Hypothesis& hypothesis : hypotheses)
    hypothesis.score = quickOverlap(pair.a, pair.b, hypothesis.T_a_b);
  keepBest(hypotheses, most);
  for (Hypothesis& hypothesis : hypotheses) {
    const PairCheck check = checkPair(pair.a, pair.b, hypothesis.T_a_b, 0);
    hypothesis.score = check.overlap * std::exp(-check.violation / rough_scale);
  }
  keepBest(hypotheses, most);
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

bool isUpright(const Eigen::Isometry3d& T) { return T.linear()(2, 2) >= upright_cosine; }

void sortModes(PairModes& modes)
{
  std::stable_sort(modes.begin(), modes.end(), [](const PairMode& x, const PairMode& y) { return x.score > y.score; });
}

// Distinct refined hypotheses, checked at the finest level.
PairModes refineHypotheses(const PairGeometry& pair, const Hypotheses& hypotheses, std::size_t most)
{
  PairModes modes;
  for (const Hypothesis& hypothesis : hypotheses) {
    const auto known = [&](const Eigen::Isometry3d& T, double factor) {
      return std::any_of(modes.begin(), modes.end(), [&](const PairMode& mode) {
        return poseDistance(mode.T_a_b, T, pair.size) < factor * pair.grain;
      });
    };
    if (modes.size() >= most)
      break;
    if (known(hypothesis.T_a_b, 3.0))
      continue;
    const PairMode mode = refinedMode(pair, hypothesis);
    if (!known(mode.T_a_b, 1.0))
      modes.push_back(mode);
  }
  return modes;
}

// Where a scan saw two places that look alike, what fits the one fits the other.
class Alternatives {
public:
  Alternatives(const PreparedScan& a, const PreparedScan& b, const PairAlignmentOptions& options)
      : pair_(geometryOf(a, b)), options_(options)
  {}

  // Adds poses in which the scans lie at the other place to the modes, which are in order.
  void addTo(PairModes& modes) const
  {
    for (std::size_t k = 0, count = std::min(twinned_most, modes.size()); k < count; ++k) {
      for (const SelfMotion& motion : pair_.a.twins)
        if (!motion.glimpsed)
          consider(modes, k, {motion.T * modes[k].T_a_b, motion.certain});
      for (const SelfMotion& motion : pair_.b.twins)
        if (!motion.glimpsed)
          consider(modes, k, {modes[k].T_a_b * motion.T, motion.certain});
    }
    sortModes(modes);
  }

private:
  void consider(PairModes& modes, std::size_t origin, const SelfMotion& candidate) const
  {
    auto known = find(modes, candidate.T, 3.0);
    if (known == modes.end()) {
      Hypothesis hypothesis;
      hypothesis.T_a_b = candidate.T;
      const PairMode mode = refinedMode(pair_, hypothesis);
      known = find(modes, mode.T_a_b, 1.0);
      if (known == modes.end() && acceptable(mode, candidate.certain))
        known = modes.insert(modes.end(), mode);
    }
    if (known != modes.end() && candidate.certain && known != modes.begin() + static_cast<std::ptrdiff_t>(origin))
      known->twin = modes[origin].twin = true;
  }

  PairModes::iterator find(PairModes& modes, const Eigen::Isometry3d& T, double grains) const
  {
    return std::find_if(modes.begin(), modes.end(), [&](const PairMode& mode) {
      return poseDistance(mode.T_a_b, T, pair_.size) < grains * pair_.grain;
    });
  }

  bool acceptable(const PairMode& mode, bool certain) const
  {
    return mode.check.violation <= options_.max_violation && (certain || mode.check.overlap >= options_.min_overlap) &&
           (!options_.upright || isUpright(mode.T_a_b));
  }

  PairGeometry pair_;
  const PairAlignmentOptions& options_;
};
} // namespace

double alignmentScore(const PairCheck& check)
{
  const double color = check.color ? std::max(0.1, *check.color) : 1.0;
  return check.overlap * color * std::exp(-check.violation / violation_scale);
}

bool clearlyWorse(double violation, double other) { return violation > std::max(2.0 * other, other + clear_violation); }

bool comparable(const PairMode& best, const PairMode& other)
{
  const PairCheck &first = best.check, &second = other.check;
  if (first.color && second.color && std::abs(*first.color - *second.color) > color_difference)
    return false;
  if (best.twin && other.twin)
    return !clearlyWorse(second.violation, first.violation);
  return second.violation <= std::max(2.0 * first.violation, first.violation + violation_scale) &&
         other.support > comparable_overlap * best.support;
}

PairModes acceptedModes(const PreparedScan& a, const PreparedScan& b, Hypotheses hypotheses,
                        const PairAlignmentOptions& options)
{
  const PairGeometry pair = geometryOf(a, b);
  rankHypotheses(pair, options.checked, hypotheses);
  PairModes modes;
  for (const PairMode& mode : refineHypotheses(pair, hypotheses, options.refined))
    if (mode.check.overlap >= options.min_overlap && mode.check.violation <= options.max_violation)
      modes.push_back(mode);
  sortModes(modes);
  return modes;
}

PairAlignment alignPair(const PreparedScan& a, const PreparedScan& b, const ScanFeatures& features_a,
                        const ScanFeatures& features_b, const PairAlignmentOptions& options)
{
  const PairGeometry pair = geometryOf(a, b);
  ConsensusOptions consensus;
  consensus.tolerance = 1.5f * a.levels[1].voxel;
  consensus.size = static_cast<float>(pair.size);
  Hypotheses hypotheses =
      findConsensus(features_a, features_b, matchFeatures(features_a, features_b, options.matches), consensus);
  if (options.upright)
    hypotheses.erase(
        std::remove_if(hypotheses.begin(), hypotheses.end(), [](const Hypothesis& h) { return !isUpright(h.T_a_b); }),
        hypotheses.end());
  const Hypotheses popular(hypotheses.begin(), hypotheses.begin() + (hypotheses.empty() ? 0 : 1));

  PairAlignment alignment;
  alignment.modes = acceptedModes(a, b, hypotheses, options);
  Alternatives(a, b, options).addTo(alignment.modes);
  for (std::size_t k = 1; k < alignment.modes.size(); ++k)
    alignment.ambiguous = alignment.ambiguous || comparable(alignment.modes[0], alignment.modes[k]);
  if (alignment.modes.empty() && !popular.empty() && popular[0].votes >= many_votes) {
    const PairMode mode = refinedMode(pair, popular[0]);
    if (mode.check.violation > options.max_violation && mode.check.overlap >= refuted_overlap)
      alignment.refuted = {mode};
  }
  return alignment;
}
} // namespace fresco::registration
