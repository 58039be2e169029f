// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/placement.h"
#include "overlap/pair_overlap.h"
#include "refinement/free_motion.h"
#include "refinement/steady_parts.h"
#include "scan/lists.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/union_find.h>
namespace fresco::registration {
namespace {
JointOptions jointOptions(const ScanRegistrationOptions& options)
{
  JointOptions joint;
  joint.min_overlap = 0.5 * options.min_overlap;
  joint.max_iterations = options.max_iterations;
  joint.covariances = true;
  joint.coarse_pairs = true;
  joint.threads = options.threads;
  return joint;
}

// Pairs of members, but for those that do not move.
std::vector<std::pair<Index, Index>> memberPairs(const Placement& placement)
{
  std::vector<std::pair<Index, Index>> pairs;
  const Index n = placement.members.size();
  for (Index a = 0; a < n; ++a)
    for (Index b = a + 1; b < n; ++b)
      if (placement.fixed.empty() || !placement.fixed[a] || !placement.fixed[b])
        pairs.emplace_back(a, b);
  return pairs;
}

// Frame of the placement from that of the scan's file.
Eigen::Isometry3d filePose(const std::vector<PreparedScan>& scans, const Placement& placement, Index member)
{
  return placement.poses[member] * Eigen::Translation3d(-scans[placement.members[member]].center);
}

struct MemberCheck {
  PairResult pair;
  Index violating_points = 0;
  bool coarse = false; // see JointPair
};

// Of two members, at the refined poses.
MemberCheck checkMembers(const std::vector<PreparedScan>& scans, const Placement& placement, Index a, Index b)
{
  MemberCheck result;
  PairResult& pair = result.pair;
  pair.a = placement.members[a];
  pair.b = placement.members[b];
  const PreparedScan &first = scans[pair.a], &second = scans[pair.b];
  const PairCheck check = checkPair(first, second, placement.poses[a].inverse() * placement.poses[b], check_level);
  pair.overlap = check.overlap;
  pair.violation = check.violation;
  pair.T_a_b = (filePose(scans, placement, a).inverse() * filePose(scans, placement, b)).matrix();
  pair.information_point = second.center;
  result.violating_points = check.violating_points;
  return result;
}

Index memberOf(const Placement& placement, Index scan)
{
  return std::find(placement.members.begin(), placement.members.end(), scan) - placement.members.begin();
}

// Takes back pairs that only coarse surfaces hold where these do not hold well: parts that all other pairs hold together, one
// scan of which may be off by more than a finest voxel: joint refinement resolves no less.
void refuseLooseParts(const std::vector<PreparedScan>& scans, const std::vector<char>& coarse, Placement& placement)
{
  UnionFind parts(placement.members.size());
  const auto forAccepted = [&](bool wanted, const auto& body) {
    for (std::size_t k = 0; k < placement.pairs.size(); ++k)
      if (PairResult& pair = placement.pairs[k]; pair.accepted && (coarse[k] != 0) == wanted)
        body(pair, memberOf(placement, pair.a), memberOf(placement, pair.b));
  };
  forAccepted(false, [&](PairResult&, Index a, Index b) { parts.join(a, b); });
  std::vector<char> loose(placement.members.size(), 0);
  for (std::size_t m = 0; m < loose.size(); ++m)
    if (positionDeviation(placement.joint, m) * voxels_per_size > scans[placement.members[m]].size)
      loose[parts.root(m)] = 1;
  forAccepted(true, [&](PairResult& pair, Index a, Index b) {
    pair.accepted = parts.root(a) == parts.root(b) || (!loose[parts.root(a)] && !loose[parts.root(b)]);
  });
}

// Finds every pair of members that overlaps.
void checkPairs(const std::vector<PreparedScan>& scans, const ScanRegistrationOptions& options, Placement& placement)
{
  const std::vector<std::pair<Index, Index>> pairs = memberPairs(placement);
  std::vector<MemberCheck> all = mapTasks(pairs.size(), options.threads, [&](Index k) {
    return checkMembers(scans, placement, pairs[k].first, pairs[k].second);
  });
  const auto find = [&](Index a, Index b) -> MemberCheck& {
    const std::pair<Index, Index> wanted = std::minmax(a, b); // pairs are in order
    return all[std::lower_bound(pairs.begin(), pairs.end(), wanted) - pairs.begin()];
  };
  for (const JointPair& joint : placement.joint.pairs) {
    MemberCheck& member = find(joint.source, joint.target);
    member.pair.rms += joint.matches * joint.rms * joint.rms;
    member.pair.matches += joint.matches;
    member.coarse = joint.coarse;
  }
  for (const PairInformation& joint : placement.joint.informations) {
    Matrix6d R = Matrix6d::Zero(); // world from axes of a
    R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = placement.poses[joint.a].linear();
    find(joint.a, joint.b).pair.information = R.transpose() * joint.information * R;
  }
  placement.pairs.clear();
  placement.violating_points = 0;
  std::vector<char> coarse; // of the pairs that are kept
  for (auto& [pair, violating_points, is_coarse] : all) {
    placement.violating_points += violating_points;
    if (pair.overlap < 0.5 * options.min_overlap && pair.violation <= options.max_violation)
      continue;
    pair.rms = std::sqrt(pair.rms / std::max<Index>(1, pair.matches));
    pair.accepted = pair.overlap >= options.min_overlap && pair.violation <= options.max_violation && pair.matches > 0;
    placement.pairs.push_back(pair);
    coarse.push_back(is_coarse);
  }
  refuseLooseParts(scans, coarse, placement);
}

// Per member, whether it is in the largest set that accepted pairs hold together.
std::vector<char> largestHeld(const Placement& placement)
{
  const Index n = placement.members.size();
  UnionFind held(n);
  for (const PairResult& pair : placement.pairs)
    if (pair.accepted)
      held.join(memberOf(placement, pair.a), memberOf(placement, pair.b));
  std::vector<Index> sizes(n, 0);
  for (Index m = 0; m < n; ++m)
    ++sizes[held.root(m)];
  const Index largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
  std::vector<char> in_largest(n);
  for (Index m = 0; m < n; ++m)
    in_largest[m] = held.root(m) == largest;
  return in_largest;
}

Index heldTogether(const Placement& placement)
{
  const std::vector<char> held = largestHeld(placement);
  return std::count(held.begin(), held.end(), 1);
}

// Whether all members are held together, and free space hardly contradicts start poses: a scan that lies on another wall
// of the same room overlaps with it by its floor.
bool suffices(const Placement& placement)
{
  const bool started = !placement.anchors.empty();
  return heldTogether(placement) == static_cast<Index>(placement.members.size()) &&
         std::none_of(placement.pairs.begin(), placement.pairs.end(),
                      [&](const PairResult& pair) { return started && pair.violation > pane_violation; });
}

// Whether more members are held together; of as many, whether free space contradicts less, by more than counts vary.
bool isBetter(const Placement& placement, const Placement& other)
{
  const Index held = heldTogether(placement), other_held = heldTogether(other);
  const double points = placement.violating_points, other_points = other.violating_points;
  return held != other_held ? held > other_held : other_points > points + 3.0 * std::sqrt(points + other_points);
}

// The part that keeps its place is the one with more of the scans that hang together.
const std::vector<Index>& smallerPart(const LooseCut& cut, const std::vector<char>& in_largest)
{
  const auto count = [&](const std::vector<Index>& part) {
    return std::count_if(part.begin(), part.end(), [&](Index m) { return in_largest[m]; });
  };
  return std::pair(count(cut.body), cut.body.size()) <= std::pair(count(cut.rest), cut.rest.size()) ? cut.body
                                                                                                    : cut.rest;
}

void findFreeMotions(Placement& placement)
{
  placement.free_motions.clear();
  for (const Matrix6d& information : placement.joint.information)
    placement.free_motions.push_back(findFreeMotion(information));
}

void addUnsteadyParts(const ScanPointers& members, const JointOptions& joint, Placement& placement)
{
  const LooseCuts& cuts = placement.joint.cuts;
  const auto motions = mapTasks(cuts.size(), joint.threads,
                                [&](Index k) { return findUnsteadyMotion(members, placement.poses, cuts[k], joint); });
  const std::vector<char> in_largest = largestHeld(placement);
  for (std::size_t k = 0; k < cuts.size(); ++k)
    if (motions[k])
      for (const Index m : smallerPart(cuts[k], in_largest))
        placement.free_motions[m] = placement.free_motions[m] ? placement.free_motions[m] : motions[k];
}

struct Reach {
  float distance = 0.f; // of corresponding points, at first
  int first_level = 0;
};

void refineWithin(const Reach& reach, const std::vector<PreparedScan>& scans, const ScanRegistrationOptions& options,
                  Placement& placement, const Progress& progress)
{
  constexpr int most_rounds = 4; // of leaving out contradicting pairs: bounds the time
  ScanPointers members;
  for (const Index i : placement.members)
    members.push_back(&scans[i]);
  JointOptions joint = jointOptions(options);
  joint.max_distance = reach.distance;
  joint.first_level = reach.first_level;
  joint.anchors = placement.anchors.empty() ? std::vector<Index>{placement.holder} : placement.anchors;
  joint.cuts = placement.anchors.empty(); // start poses tell which of two places a few voxels apart is meant
  joint.fixed = placement.fixed;
  const auto refine = [&](const IsometryVector& poses) {
    placement.joint = refineJointly(members, poses, joint, progress);
    placement.poses = placement.joint.poses;
    checkPairs(scans, options, placement);
    findFreeMotions(placement);
  };
  const IsometryVector start = placement.poses;
  for (int round = 0; round < most_rounds; ++round) {
    refine(start);
    const std::size_t before = joint.excluded.size();
    for (const PairResult& pair : placement.pairs)
      if (pair.matches > 0 && pair.violation > options.max_violation)
        joint.excluded.emplace_back(memberOf(placement, pair.a), memberOf(placement, pair.b));
    if (joint.excluded.size() == before)
      break;
  }
  if (!placement.fixed.empty())
    return;
  // What hangs together by surfaces that hold it loosely: the larger part stays.
  std::vector<Index> loose;
  for (std::size_t m = 0; m < placement.members.size(); ++m)
    if (isLoose(*members[m], placement, m))
      loose.push_back(m);
  if (2 * loose.size() > placement.members.size()) {
    joint.anchors = {loose.front()};
    refine(placement.poses);
  }
  addUnsteadyParts(members, joint, placement);
}

Reach nearReach(const ScanRegistrationOptions& options)
{
  return {std::min(options.max_distance, near_voxels * options.voxel), check_level};
}
} // namespace

double positionDeviation(const JointResult& joint, Index member)
{
  return std::sqrt(joint.covariances[member].bottomRightCorner<3, 3>().trace());
}

bool holds(double deviation, const PreparedScan& scan)
{
  constexpr double most_deviation = 0.02; // of the scan's size: what is next to it would no longer fit
  return deviation <= most_deviation * scan.size;
}

bool isLoose(const PreparedScan& scan, const Placement& placement, Index member)
{
  return placement.free_motions[member] ||
         (sawAround(scan) && !holds(positionDeviation(placement.joint, member), scan));
}

namespace {
// Refines start poses within a wide reach: only those that the data do not confirm where they are, then all together.
// @param near refined from where they are
Placement refineUnconfirmed(const std::vector<PreparedScan>& scans, const ScanRegistrationOptions& options,
                            const Placement& near, const Progress& progress)
{
  Placement far = near;
  far.fixed = largestHeld(near);
  for (const PairResult& pair : near.pairs)
    if (pair.violation > pane_violation)
      for (const Index scan : {pair.a, pair.b})
        far.fixed[memberOf(near, scan)] = 0;
  for (std::size_t m = 0; m < near.fixed.size(); ++m)
    far.fixed[m] = far.fixed[m] || near.fixed[m];
  refineWithin({options.max_distance, 0}, scans, options, far, progress);
  far.fixed = near.fixed;
  refineWithin(nearReach(options), scans, options, far, progress);
  return far;
}
} // namespace

void refinePlacement(const std::vector<PreparedScan>& scans, const ScanRegistrationOptions& options,
                     Placement& placement, const Progress& progress)
{
  Placement near = placement;
  refineWithin(nearReach(options), scans, options, near, progress);
  if (!suffices(near)) {
    if (placement.anchors.empty())
      refineWithin({options.max_distance, 0}, scans, options, placement, progress);
    else
      placement = refineUnconfirmed(scans, options, near, progress);
    if (isBetter(placement, near))
      return;
  }
  placement = std::move(near);
}
} // namespace fresco::registration
