// SPDX-License-Identifier: BSD-3-Clause
#include "registration_result.h"
#include "answer/odds.h"
#include "answer/places.h"
#include "scan/floor_plan.h"
#include "scan/lists.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/core/union_find.h>
#include <map>
namespace fresco::registration {
namespace {
using Groups = std::vector<std::vector<Index>>;

// Whether free space contradicts what a hint brings together: of scans that other pairs hold to either side.
bool isContradicted(const HintedJoin& join, const Placement& placement, UnionFind& held, double most_violation)
{
  const Index a = held.root(join.a), b = held.root(join.b);
  return std::any_of(placement.pairs.begin(), placement.pairs.end(), [&](const PairResult& pair) {
    const Index first = held.root(pair.a), second = held.root(pair.b);
    return pair.violation > most_violation && ((first == a && second == b) || (first == b && second == a)) && a != b;
  });
}

// Members held together by accepted pairs, by hints or because none moves, largest group first after that, each in rising
// order.
Groups acceptedGroups(const Placement& placement, Index scan_count, double most_violation)
{
  UnionFind held(scan_count);
  Index fixed = -1;
  for (std::size_t m = 0; m < placement.fixed.size(); ++m)
    if (placement.fixed[m]) {
      fixed = fixed < 0 ? placement.members[m] : fixed;
      held.join(fixed, placement.members[m]);
    }
  for (const PairResult& pair : placement.pairs)
    if (pair.accepted)
      held.join(pair.a, pair.b);
  for (const HintedJoin& join : placement.hinted)
    if (!isContradicted(join, placement, held, most_violation))
      held.join(join.a, join.b);
  Groups groups(scan_count);
  for (const Index scan : placement.members)
    groups[held.root(scan)].push_back(scan);
  groups.erase(std::remove_if(groups.begin(), groups.end(), [](const auto& g) { return g.empty(); }), groups.end());
  const auto holdsFixed = [&](const std::vector<Index>& group) {
    return std::find(group.begin(), group.end(), fixed) != group.end();
  };
  std::stable_sort(groups.begin(), groups.end(), [&](const auto& a, const auto& b) {
    return holdsFixed(a) != holdsFixed(b) ? holdsFixed(a) : a.size() > b.size();
  });
  return groups;
}

double pooledRms(const std::vector<PairResult>& pairs, Index scan)
{
  double squares = 0.0, count = 0.0;
  for (const PairResult& pair : pairs)
    if (pair.accepted && (scan < 0 || pair.a == scan || pair.b == scan)) {
      squares += pair.matches * pair.rms * pair.rms;
      count += pair.matches;
    }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

// The placed scan whose free space contradicts the place of `scan`, -1 if none does.
Index contradictingScan(const std::vector<PairResult>& pairs, Index scan, const std::vector<Index>& placed,
                        double limit)
{
  for (const PairResult& pair : pairs)
    for (const auto& [one, other] : {std::pair(pair.a, pair.b), std::pair(pair.b, pair.a)})
      if (one == scan && pair.violation > limit && std::find(placed.begin(), placed.end(), other) != placed.end())
        return other;
  return -1;
}

class Description {
public:
  explicit Description(const RegistrationState& state)
      : state_(state), scans_(state.scans), start_(state.start), options_(state.options), refusals_(scans_.size()),
        loose_(scans_.size(), 0)
  {
    result_.hints = state.hints;
    result_.voxel = options_.voxel;
    result_.poses.resize(scans_.size());
    result_.scans.resize(scans_.size());
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      result_.scans[i].problem = scans_[i].problem;
      if (!scans_[i].problem.empty())
        result_.scans[i].refusal.reason = RefusalReason::unusable;
      result_.scans[i].duplicate_of = scans_[i].duplicate_of;
      result_.scans[i].viewpoint_problem = scans_[i].viewpoint_problem;
      if (scans_[i].viewpoint_found && scans_[i].oriented)
        result_.scans[i].found_viewpoint = scans_[i].center;
    }
  }

  ScanRegistrationResult run();

private:
  ScanResult& scan(Index i) { return result_.scans[i]; }
  bool started(Index i) const { return !start_.empty() && start_[i].has_value(); }
  void describeScans(const Placement& placement);
  void placeMain(const std::vector<Index>& group);
  void placeOther(const std::vector<Index>& group, const std::vector<Index>& main, bool same_frame);
  void placeDuplicates();
  void addTriedPairs();
  void drawOutlines();
  void describeHints(const Placement& placement);
  void findCandidates(const std::vector<ScanCluster>& groups, const FreeSpaceJudge& judge);
  Refusal refusalOf(Index group) const;

  const RegistrationState& state_;
  const std::vector<PreparedScan>& scans_;
  const std::vector<Pose>& start_;
  const ScanRegistrationOptions& options_;
  ScanRegistrationResult result_;
  std::vector<Refusal> refusals_; // per scan, of its cluster
  std::vector<char> loose_;       // per scan
};

void Description::describeScans(const Placement& placement)
{
  for (std::size_t m = 0; m < placement.members.size(); ++m) {
    const Index i = placement.members[m];
    const PreparedScan& prepared = scans_[i];
    scan(i).T_group_scan = (placement.poses[m] * Eigen::Translation3d(-prepared.center)).matrix();
    scan(i).rms = pooledRms(placement.pairs, i);
    if (!placement.fixed.empty() && placement.fixed[m]) {
      scan(i).T_group_scan = *start_[i]; // to the last bit
      continue;
    }
    scan(i).free_motion = placement.free_motions[m];
    loose_[i] = isLoose(prepared, placement, m);
    const Matrix6d& covariance = placement.joint.covariances[m];
    const FreeMotion free = scan(i).free_motion.value_or(FreeMotion());
    const auto deviation = [](double held, const Eigen::Vector3d& free_direction, double reach) {
      return !free_direction.isZero() || !(held < reach) ? reach : held;
    };
    scan(i).translation_deviation =
        deviation(positionDeviation(placement.joint, m), free.translation, options_.max_distance);
    scan(i).rotation_deviation = deviation(std::sqrt(covariance.topLeftCorner<3, 3>().trace()), free.rotation,
                                           options_.max_distance / prepared.size);
  }
}

void Description::placeMain(const std::vector<Index>& group)
{
  for (const Index i : group) {
    const bool held = started(i) && holds(options_.max_distance, scans_[i]);
    if (loose_[i] && !held && scan(i).hint.empty()) {
      scan(i).refusal.reason = RefusalReason::loose;
      scan(i).problem =
          scan(i).free_motion
              ? "its surfaces leave a motion free, and nothing tells where along it the scan belongs"
              : concat("what it shares with other scans holds it only to ", scan(i).translation_deviation);
      if (started(i))
        scan(i).problem += concat("; `none` has it searched; its start pose is good to ", options_.max_distance);
      continue;
    }
    scan(i).placed = true;
    result_.poses[i] = scan(i).T_group_scan;
    if (scan(i).free_motion && scan(i).problem.empty())
      scan(i).problem = "its surfaces leave a motion free: the pose is arbitrary along it";
  }
}

// What decided, or else what the data say of the best place that was found.
Refusal Description::refusalOf(Index group) const
{
  const auto in_group = [&](const ScanResult& s) { return s.group == group; };
  const Index first = std::find_if(result_.scans.begin(), result_.scans.end(), in_group) - result_.scans.begin();
  Refusal refusal = refusals_[first];
  if (refusal.reason != RefusalReason::none)
    return refusal;
  const auto best =
      std::find_if(result_.candidates.begin(), result_.candidates.end(), [&](const CandidatePlace& place) {
        return place.group == group && result_.scans[place.beside].group == 0;
      });
  if (best == result_.candidates.end())
    return {RefusalReason::nothing_found};
  return {best->contradicted ? RefusalReason::contradicted : RefusalReason::too_little, best->beside, best->agree,
          best->contradict};
}

void Description::placeOther(const std::vector<Index>& group, const std::vector<Index>& main, bool same_frame)
{
  const Refusal refusal = refusalOf(scan(group[0]).group);
  for (const Index i : group) {
    const Index against = same_frame ? contradictingScan(result_.pairs, i, main, options_.max_violation) : -1;
    if (against >= 0) {
      scan(i).refusal = {RefusalReason::contradicted, against};
      scan(i).problem = "its place contradicts what " + scanName(options_, against) + " saw through";
    } else if (same_frame && started(i)) {
      scan(i).placed = true;
      scan(i).problem = "overlaps none of the other placed scans enough: its start pose is kept unconfirmed";
      scan(i).translation_deviation = options_.max_distance;
      scan(i).rotation_deviation = options_.max_distance / scans_[i].size;
      result_.poses[i] = scan(i).T_group_scan;
    } else {
      scan(i).refusal = refusal;
      scan(i).problem = refusalText(refusal, options_);
    }
    if (scan(i).free_motion)
      scan(i).problem += "; within its group, its surfaces leave a motion free";
  }
}

// Where the scan is that has the same points.
void Description::placeDuplicates()
{
  const Index n = scans_.size();
  for (Index i = 0; i < n; ++i) {
    const Index original = scans_[i].duplicate_of;
    if (original < 0)
      continue;
    const std::string problem = scan(i).problem;
    scan(i) = scan(original);
    scan(i).refusal.reason = scan(i).placed ? RefusalReason::none : RefusalReason::unusable;
    scan(i).duplicate_of = original;
    scan(i).problem = problem + (scan(i).placed ? ": placed on it" : ", which has no place");
    result_.poses[i] = result_.poses[original];
    if (scan(i).group < 0)
      continue;
    PairResult& pair = result_.pairs.emplace_back();
    pair.a = std::min(i, original);
    pair.b = std::max(i, original);
    pair.overlap = 1.0;
    pair.accepted = true;
    pair.information_point = scans_[original].center;
  }
}

// Pairs that are not in one placement have the best pose of those found; the others of each pair are its alternatives.
void Description::addTriedPairs()
{
  std::map<std::pair<Index, Index>, std::size_t> known;
  for (std::size_t k = 0; k < result_.pairs.size(); ++k)
    known.emplace(std::pair(result_.pairs[k].a, result_.pairs[k].b), k);
  for (const PairAlignment& tried : state_.tried) {
    const PreparedScan &a = scans_[tried.a], &b = scans_[tried.b];
    const PairGeometry geometry(a, b);
    const auto at = known.find({tried.a, tried.b});
    const bool is_new = at == known.end();
    if (is_new && tried.hypotheses.empty())
      continue;
    PairResult& pair = is_new ? result_.pairs.emplace_back() : result_.pairs[at->second];
    const Eigen::Translation3d to_working(-b.center);
    for (const VerifiedHypothesis& hypothesis : tried.hypotheses) {
      const Eigen::Isometry3d T = Eigen::Translation3d(a.center) * hypothesis.T_a_b * to_working;
      const Eigen::Isometry3d taken(Eigen::Translation3d(-a.center) * Eigen::Isometry3d(pair.T_a_b) *
                                    Eigen::Translation3d(b.center));
      if (is_new && &hypothesis == &tried.hypotheses.front()) {
        pair.a = tried.a;
        pair.b = tried.b;
        pair.overlap = hypothesis.check.overlap;
        pair.violation = hypothesis.check.violation;
        pair.T_a_b = T.matrix();
        pair.information_point = b.center;
      } else if (is_new || poseDistance(taken, hypothesis.T_a_b, geometry.size) > geometry.grain) {
        pair.alternatives.push_back({T.matrix(), hypothesis.check.overlap, hypothesis.check.violation});
      }
    }
  }
}

// A hint's place is kept where nothing contradicts it, as a start pose is.
void Description::describeHints(const Placement& placement)
{
  UnionFind held(scans_.size());
  for (const PairResult& pair : placement.pairs)
    if (pair.accepted)
      held.join(pair.a, pair.b);
  for (const HintedJoin& join : placement.hinted) {
    const bool confirmed = held.root(join.a) == held.root(join.b);
    const char* what = confirmed ? ", and surfaces confirm it" : ", which surfaces do not confirm";
    if (isContradicted(join, placement, held, options_.max_violation)) {
      result_.hints.push_back(join.hint + ": not followed: free space contradicts it");
      continue;
    }
    for (const Index i : join.moved) {
      scan(i).hint = join.hint;
      if (confirmed)
        continue;
      scan(i).problem = "placed by a hint alone: " + join.hint;
      scan(i).translation_deviation = options_.max_distance;
      scan(i).rotation_deviation = options_.max_distance / scans_[i].size;
    }
    held.join(join.a, join.b);
    result_.hints.push_back(
        concat(join.hint, ": ", scanName(options_, join.a), " and ", scanName(options_, join.b), " are joined", what));
  }
}

void Description::drawOutlines()
{
  constexpr Index most = 900; // points: a wall of 10 m gets some dozens
  const PlanFrames frames = findPlanFrames(scans_, options_.threads);
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    if (!scans_[i].problem.empty())
      continue;
    const ScanLevel& level = scans_[i].levels[check_level];
    const Eigen::Vector3f up =
        frames[i] ? frames[i]->T_plan_scan.linear().row(2).transpose().eval() : Eigen::Vector3f::UnitZ().eval();
    std::vector<Index> chosen;
    for (Index k = 0; k < level.points.cols(); ++k)
      if (std::abs(level.normals.col(k).dot(up)) < std::sqrt(1 - facing * facing))
        chosen.push_back(k);
    const Index step = std::max<Index>(1, static_cast<Index>(chosen.size()) / most);
    scan(i).up = up.cast<double>();
    scan(i).outline.resize(3, (static_cast<Index>(chosen.size()) + step - 1) / step);
    for (Index k = 0; k < scan(i).outline.cols(); ++k)
      scan(i).outline.col(k) = level.points.col(chosen[k * step]) + scans_[i].center.cast<float>();
  }
}

void Description::findCandidates(const std::vector<ScanCluster>& groups, const FreeSpaceJudge& judge)
{
  constexpr std::size_t most = 4;        // of a group: a person looks at no more
  constexpr double least_overlap = 0.02; // of two scans: of less, nobody can tell whether they fit
  const PlaceFinder finder(scans_, state_.tried, state_.plan_places, options_);
  const auto found = mapTasks(groups.size(), options_.threads, [&](Index g) {
    std::vector<CandidatePlace> candidates;
    Places places;
    for (Index larger = 0; larger < g; ++larger)
      for (const Place& place : finder.ofClusters(groups[larger], groups[g]))
        places.push_back(place);
    finder.judge(groups, judge, places);
    for (const Place& place : places) {
      if (candidates.size() == most || place.fit.overlap < least_overlap)
        continue;
      CandidatePlace& candidate = candidates.emplace_back(finder.described(place));
      candidate.group = g;
      const Eigen::Matrix4d T_larger_scan = result_.scans[place.a].T_group_scan * candidate.T_beside_scan;
      candidate.T_larger_group = T_larger_scan * result_.scans[place.b].T_group_scan.inverse();
    }
    return candidates;
  });
  for (const auto& candidates : found)
    result_.candidates.insert(result_.candidates.end(), candidates.begin(), candidates.end());
}

ScanRegistrationResult Description::run()
{
  const std::vector<Placement>& placements = state_.placements;
  for (const Placement& placement : placements) {
    result_.pairs.insert(result_.pairs.end(), placement.pairs.begin(), placement.pairs.end());
    result_.iterations = std::max(result_.iterations, placement.joint.iterations);
    result_.converged = (&placement == &placements.front() || result_.converged) && placement.joint.converged;
    describeScans(placement);
    describeHints(placement);
    for (const Index i : placement.members)
      refusals_[i] = placement.refusal;
  }
  result_.rms = pooledRms(result_.pairs, -1);
  result_.people_moved = std::any_of(scans_.begin(), scans_.end(), [](const auto& s) { return s.spares_doubtful; });
  std::vector<ScanCluster> groups;
  std::vector<char> same_frame; // per group, as the first one
  for (const Placement& placement : placements)
    for (const std::vector<Index>& group : acceptedGroups(placement, scans_.size(), options_.max_violation)) {
      ScanCluster& cluster = groups.emplace_back();
      cluster.scans = group;
      cluster.hinted = placement.hinted;
      for (const Index i : group) {
        scan(i).group = result_.groups;
        cluster.poses.push_back(Eigen::Isometry3d(scan(i).T_group_scan) * Eigen::Translation3d(scans_[i].center));
      }
      same_frame.push_back(&placement == &placements.front());
      ++result_.groups;
    }
  const FreeSpaceJudge judge(scans_);
  findCandidates(groups, judge);
  describeOdds(groups, judge, options_.threads, result_);
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (g == 0)
      placeMain(groups[0].scans);
    else
      placeOther(groups[g].scans, groups[0].scans, same_frame[g]);
  drawOutlines();
  addTriedPairs();
  placeDuplicates();
  std::sort(result_.pairs.begin(), result_.pairs.end(),
            [](const PairResult& x, const PairResult& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  return std::move(result_);
}
} // namespace

ScanRegistrationResult describeRegistration(const RegistrationState& state) { return Description(state).run(); }
} // namespace fresco::registration
