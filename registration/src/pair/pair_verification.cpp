// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_verification.h"
#include "refinement/free_motion.h"
#include "refinement/joint_refinement.h"
#include "scan/lists.h"
#include <algorithm>
#include <cmath>
namespace fresco::registration {
namespace {
constexpr double violation_scale = 0.005; // of violations that costs a factor e: little contradiction outweighs much
                                          // overlap

// Keeps those that are best by their check on a level.
void rankByCheck(const PairGeometry& pair, int level, std::size_t most, PoseHypotheses& hypotheses)
{
  constexpr double rough_scale = 0.03; // as violation_scale, but before refinement, when right poses violate too
  for (PoseHypothesis& hypothesis : hypotheses) {
    const PairCheck check = checkRoughly(pair.a, pair.b, hypothesis.T_a_b, level);
    hypothesis.score = check.overlap * std::exp(-check.violation / rough_scale);
  }
  keepLargest(hypotheses, most, &PoseHypothesis::score);
}

// The hypotheses worth refining, best first.
void rankHypotheses(const PairGeometry& pair, std::size_t most, FoundHypotheses& found)
{
  rankByCheck(pair, 0, most, found.features);
  rankByCheck(pair, 0, most, found.plans);
  rankByCheck(pair, 0, most, found.planes);
  rankByCheck(pair, 1, most, found.planes);
}

VerifiedHypothesis verifyOn(const PairGeometry& pair, const PoseHypothesis& hypothesis, const LevelRange& levels)
{
  constexpr Index samples = 1000;
  VerifiedHypothesis verified;
  const JointResult refined = refinePair({pair.a, pair.b}, hypothesis.T_a_b, levels, samples);
  verified.T_a_b = refined.poses[1];
  verified.has_free_motion = findFreeMotion(refined.information[1]).has_value();
  verified.votes = hypothesis.votes;
  verified.check = checkPair(pair.a, pair.b, verified.T_a_b, check_level);
  // Without free space on both sides, features are the only other witnesses.
  const bool blind = pair.a.free_space.empty() || pair.b.free_space.empty();
  const double trust = blind ? std::min(1.0, 1.0 * verified.votes / many_votes) : 1.0;
  verified.support = trust * verified.check.overlap;
  verified.score = trust * alignmentScore(verified.check);
  return verified;
}

constexpr double comparable_overlap = 0.3; // share of the best support: less, and mere chance explains it

// Whether scans that do not overlap would explain what was found about as well.
bool isChance(const PairCheck& check)
{
  return check.overlap * std::exp(-check.violation / violation_scale) <
         comparable_overlap * VerificationOptions{}.min_overlap;
}

// How well scans agree at a pose before its refinement: alignmentScore() of few samples without colours, 0 where it is
// chance.
double roughScore(const PairGeometry& pair, const Eigen::Isometry3d& T_a_b)
{
  const PairCheck check = checkRoughly(pair.a, pair.b, T_a_b, check_level);
  return isChance(check) ? 0.0 : alignmentScore(check);
}

// Whether refinement moved a pose that was about as good before. Scans that share only what a door shows are drawn away
// by coarse surfaces: by half a metre in a room. A scan on itself shares more.
bool isDrawnAway(const PairGeometry& pair, const Eigen::Isometry3d& start, const VerifiedHypothesis& refined)
{
  constexpr double as_good = 0.7; // of the score: a start is off by a part of a voxel
  return &pair.a != &pair.b && poseDistance(start, refined.T_a_b, pair.size) > 0.5 * pair.a.levels[check_level].voxel &&
         roughScore(pair, start) > as_good * roughScore(pair, refined.T_a_b);
}

// Whether a start need not be tried: what is near it already explains the scans better.
bool isTried(const PairGeometry& pair, const Eigen::Isometry3d& start, const VerifiedHypothesis& near)
{
  return !clearlyWorse(near.check.violation, 0.0) || roughScore(pair, start) <= near.score;
}

// Adds up to `most` distinct refined hypotheses, checked at the finest level. Of two that end at one place the better one
// stays.
// @param reach of a refined one: what starts within it is not tried, unless it is better before it is refined, length
void refineHypotheses(const PairGeometry& pair, const PoseHypotheses& hypotheses, std::size_t most, double reach,
                      VerifiedHypotheses& verified)
{
  most += verified.size();
  for (const PoseHypothesis& hypothesis : hypotheses) {
    if (verified.size() >= most)
      break;
    const auto near = findNear(pair, verified, hypothesis.T_a_b, reach);
    if (near != verified.end() && isTried(pair, hypothesis.T_a_b, *near))
      continue;
    const VerifiedHypothesis next = verifyHypothesis(pair, hypothesis);
    const auto same = findNear(pair, verified, next.T_a_b, pair.tolerance);
    if (same == verified.end())
      verified.push_back(next);
    else if (next.score > same->score)
      *same = next;
  }
}

// Whether `other` explains two scans about as well as `best` does.
bool comparable(const VerifiedHypothesis& best, const VerifiedHypothesis& other)
{
  constexpr double color_difference = 0.3; // of correlations: sampling does not cause it, so colours decide
  const PairCheck &first = best.check, &second = other.check;
  if (first.color && second.color && std::abs(*first.color - *second.color) > color_difference)
    return false;
  if (best.has_alias && other.has_alias)
    return !clearlyWorse(second.violation, first.violation);
  return second.violation <= std::max(2.0 * first.violation, first.violation + violation_scale) &&
         other.support > comparable_overlap * best.support;
}
} // namespace

PairGeometry::PairGeometry(const PreparedScan& scan_a, const PreparedScan& scan_b)
    : a(scan_a), b(scan_b), size(std::sqrt(a.size * b.size)), grain(4.0 * a.levels[1].voxel),
      tolerance(4.0 * a.levels.back().voxel)
{}

VerifiedHypotheses::iterator findNear(const PairGeometry& pair, VerifiedHypotheses& hypotheses,
                                      const Eigen::Isometry3d& T_a_b, double distance)
{
  return std::find_if(hypotheses.begin(), hypotheses.end(), [&](const VerifiedHypothesis& other) {
    return poseDistance(other.T_a_b, T_a_b, pair.size) < distance;
  });
}

double alignmentScore(const PairCheck& check)
{
  const double color = check.color ? std::max(0.1, *check.color) : 1.0;
  return check.overlap * color * std::exp(-check.violation / violation_scale);
}

bool clearlyWorse(double violation, double other) { return violation > std::max(2.0 * other, other + noise_violation); }

bool isAmbiguous(const PairGeometry& pair, const VerifiedHypotheses& hypotheses)
{
  if (hypotheses.empty())
    return false;
  const VerifiedHypothesis& best = hypotheses.front();
  // A camera sees too little to rule out what fits by chance, as one of hundreds of poses by planes does. Of scanners
  // that saw around no wrong pose has much overlap, and with coarse noise the true one violates, too.
  const bool narrow = !(sawAround(pair.a) && sawAround(pair.b));
  return (narrow && (best.votes == 0 || isChance(best.check))) || best.has_free_motion ||
         std::any_of(hypotheses.begin() + 1, hypotheses.end(),
                     [&](const VerifiedHypothesis& other) { return comparable(best, other); });
}

VerifiedHypothesis verifyHypothesis(const PairGeometry& pair, const PoseHypothesis& hypothesis)
{
  const VerifiedHypothesis verified = verifyOn(pair, hypothesis, {0, 1});
  if (!isDrawnAway(pair, hypothesis.T_a_b, verified))
    return verified;
  const VerifiedHypothesis nearby = verifyOn(pair, hypothesis, {check_level, check_level});
  return nearby.score > verified.score ? nearby : verified;
}

VerifiedHypotheses verifyHypotheses(const PairGeometry& pair, FoundHypotheses found, const VerificationOptions& options)
{
  rankHypotheses(pair, options.checked, found);
  VerifiedHypotheses refined_all, accepted;
  // Features say where something is in all directions. What walls say may slide along a corridor, and stay there.
  refineHypotheses(pair, found.features, options.refined, 3.0 * pair.grain, refined_all);
  for (const PoseHypotheses* poses : {&found.planes, &found.plans})
    refineHypotheses(pair, *poses, options.refined, pair.tolerance, refined_all);
  for (const VerifiedHypothesis& verified : refined_all)
    if (verified.check.overlap >= options.min_overlap && verified.check.violation <= options.max_violation)
      accepted.push_back(verified);
  sortFalling(accepted, &VerifiedHypothesis::score);
  return accepted;
}
} // namespace fresco::registration
