// SPDX-License-Identifier: BSD-3-Clause
#include "graph/scan_assembly.h"
#include "graph/alias_check.h"
#include "graph/free_space_evidence.h"
#include "graph/place_check.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <map>
namespace fresco::registration {
namespace {
// A place of one cluster in another.
struct ClusterFit {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity(); // frame of the first from that of the second
  Index pairs = 0;                                     // that lead to it
  double overlap = 0.0;                                // the largest of theirs
  bool sound = false;                                  // one of them is sure of it
  FreeSpaceEvidence evidence;
};
using ClusterFits = std::vector<ClusterFit, Eigen::aligned_allocator<ClusterFit>>;

class Assembler {
public:
  Assembler(const GraphInput& input, const ScanCluster& known)
      : input_(input), known_(known), judge_(input.scans), least_color_(leastColor(input.pairs)),
        pairs_of_(input.scans.size())
  {
    begin();
  }

  ScanGraph run();

private:
  struct Group {
    Index id; // changes with its members
    ScanCluster cluster;
  };
  struct Join {
    std::size_t first, second; // groups
    ClusterFit fit;
  };
  using Joins = std::vector<Join, Eigen::aligned_allocator<Join>>;

  void begin();
  bool isSound(const PairAlignment& pair, const VerifiedHypothesis& hypothesis) const;
  void addFit(const ScanCluster& second, const ClusterFit& fit, ClusterFits& fits) const;
  ClusterFits findFits(const ScanCluster& first, const ScanCluster& second) const;
  void findAllFits();
  ClusterFits fitsOf(std::size_t first, std::size_t second) const;
  bool isSame(const ScanCluster& moving, const Eigen::Isometry3d& T, const Eigen::Isometry3d& other,
              double tolerances) const;
  bool rivals(const ClusterFit& other, const ClusterFit& fit) const;
  bool hasAlias(const Join& join) const;
  bool hasSecondPlace(const Join& join) const;
  bool fitsThird(std::size_t stays, std::size_t moves, const ClusterFit& fit);
  Joins likelyJoins() const;
  bool joinBest();
  void join(const Join& join);

  const GraphInput& input_;
  const ScanCluster& known_;
  FreeSpaceJudge judge_;
  double least_color_;
  std::vector<std::vector<const PairAlignment*>> pairs_of_; // per scan
  std::vector<Group> groups_;
  Index next_id_ = 0;
  std::map<std::pair<Index, Index>, ClusterFits> fits_; // by the ids of two groups, the lower first
};

void Assembler::begin()
{
  for (const PairAlignment& pair : input_.pairs) {
    pairs_of_[pair.a].push_back(&pair);
    pairs_of_[pair.b].push_back(&pair);
  }
  if (!known_.scans.empty())
    groups_.push_back({next_id_++, known_});
  const Index n = input_.scans.size();
  for (Index i = 0; i < n; ++i)
    if (input_.scans[i].problem.empty() && std::find(known_.scans.begin(), known_.scans.end(), i) == known_.scans.end())
      groups_.push_back({next_id_++, {{i}, {Eigen::Isometry3d::Identity()}}});
}

// Whether two scans alone are sure of their pose.
bool Assembler::isSound(const PairAlignment& pair, const VerifiedHypothesis& hypothesis) const
{
  constexpr double noise_violation = 0.002; // mixed pixels do not cause more
  return !pair.ambiguous && &hypothesis == &pair.hypotheses.front() &&
         hypothesis.check.overlap >= input_.options.strong_overlap && hypothesis.check.violation <= noise_violation;
}

bool Assembler::isSame(const ScanCluster& moving, const Eigen::Isometry3d& T, const Eigen::Isometry3d& other,
                       double tolerances) const
{
  return poseDistance(T * moving.poses[0], other * moving.poses[0], input_.scans[moving.scans[0]].size) <
         tolerances * input_.options.tolerance;
}

void Assembler::addFit(const ScanCluster& second, const ClusterFit& fit, ClusterFits& fits) const
{
  for (ClusterFit& known : fits)
    if (isSame(second, known.T, fit.T, 2.0)) {
      ++known.pairs;
      known.sound = known.sound || fit.sound;
      if (fit.overlap > known.overlap) {
        known.overlap = fit.overlap;
        known.T = fit.T;
      }
      return;
    }
  fits.push_back(fit);
}

ClusterFits Assembler::findFits(const ScanCluster& first, const ScanCluster& second) const
{
  constexpr double loose_violation = 0.01; // of one pair: others may have seen a pane
  ClusterFits fits;
  std::map<Index, std::size_t> positions;
  for (std::size_t k = 0; k < second.scans.size(); ++k)
    positions[second.scans[k]] = k;
  for (std::size_t i = 0; i < first.scans.size(); ++i)
    for (const PairAlignment* pair : pairs_of_[first.scans[i]]) {
      const bool turned = pair->b == first.scans[i];
      const auto other = positions.find(turned ? pair->a : pair->b);
      if (other == positions.end())
        continue;
      for (const VerifiedHypothesis& hypothesis : pair->hypotheses) {
        if (hypothesis.check.violation > loose_violation || hypothesis.check.color.value_or(1.0) < least_color_)
          continue;
        ClusterFit fit;
        fit.T = first.poses[i] * (turned ? hypothesis.T_a_b.inverse() : hypothesis.T_a_b) *
                second.poses[other->second].inverse();
        fit.pairs = 1;
        fit.overlap = hypothesis.check.overlap;
        fit.sound = isSound(*pair, hypothesis);
        addFit(second, fit, fits);
      }
    }
  for (ClusterFit& fit : fits)
    fit.evidence = judge_.judge(first, second, fit.T);
  fits.erase(std::remove_if(fits.begin(), fits.end(), [](const auto& fit) { return isContradicted(fit.evidence); }),
             fits.end());
  return fits;
}

// Of all groups in each other, those that are new.
void Assembler::findAllFits()
{
  std::vector<std::pair<const Group*, const Group*>> fresh;
  for (std::size_t i = 0; i < groups_.size(); ++i)
    for (std::size_t k = i + 1; k < groups_.size(); ++k) {
      const Group& first = groups_[i].id < groups_[k].id ? groups_[i] : groups_[k];
      const Group& second = &first == &groups_[i] ? groups_[k] : groups_[i];
      if (fits_.find({first.id, second.id}) == fits_.end())
        fresh.push_back({&first, &second});
    }
  std::vector<ClusterFits> found(fresh.size());
  parallelFor(
      fresh.size(), input_.options.threads,
      [&](Index k) { found[k] = findFits(fresh[k].first->cluster, fresh[k].second->cluster); }, 1);
  for (std::size_t k = 0; k < fresh.size(); ++k)
    fits_[{fresh[k].first->id, fresh[k].second->id}] = std::move(found[k]);
}

// Of the second group in the first.
ClusterFits Assembler::fitsOf(std::size_t first, std::size_t second) const
{
  const Index a = groups_[first].id, b = groups_[second].id;
  ClusterFits fits = fits_.at({std::min(a, b), std::max(a, b)});
  if (a > b)
    for (ClusterFit& fit : fits)
      fit.T = fit.T.inverse();
  return fits;
}

// Whether one place makes another doubtful. Overlap hardly counts: of equal rooms, the wrong one may be seen best.
bool Assembler::rivals(const ClusterFit& other, const ClusterFit& fit) const
{
  constexpr double least_share = 0.25;  // of the surfaces that agree at this place: less, and chance explains them
  constexpr double overlap_share = 0.4; // likewise
  return other.evidence.agree >= least_share * fit.evidence.agree &&
         !contradictsMore(other.evidence, fit.evidence, judge_.unit()) &&
         (other.sound || other.overlap >= overlap_share * fit.overlap);
}

// Whether a scan of either group saw two places that look alike, and the other group fits at both.
bool Assembler::hasAlias(const Join& join) const
{
  return hasAliasByScan(input_, {groups_[join.first].cluster, groups_[join.second].cluster},
                        {0, 1, join.fit.T, join.fit.overlap});
}

bool Assembler::hasSecondPlace(const Join& join) const
{
  const ClusterFits fits = fitsOf(join.first, join.second);
  return std::any_of(fits.begin(), fits.end(), [&](const ClusterFit& other) {
    return !isSame(groups_[join.second].cluster, other.T, join.fit.T, 3.0) && rivals(other, join.fit);
  });
}

// Whether a group that moves has a place in a third one, and free space contradicts the first and the third there.
bool Assembler::fitsThird(std::size_t stays, std::size_t moves, const ClusterFit& fit)
{
  for (std::size_t third = 0; third < groups_.size(); ++third) {
    if (third == stays || third == moves)
      continue;
    for (const ClusterFit& other : fitsOf(third, moves)) {
      if (!other.sound || !rivals(other, fit))
        continue;
      const Eigen::Isometry3d T_stays_third = fit.T * other.T.inverse();
      if (isContradicted(judge_.judge(groups_[stays].cluster, groups_[third].cluster, T_stays_third)))
        return true;
    }
  }
  return false;
}

// Most agreement first.
Assembler::Joins Assembler::likelyJoins() const
{
  constexpr double least_overlap = 0.2;   // of the best pair
  constexpr double least_agreement = 0.5; // of a scan's points: a quarter of two
  Joins joins;
  for (std::size_t i = 0; i < groups_.size(); ++i)
    for (std::size_t k = i + 1; k < groups_.size(); ++k)
      for (const ClusterFit& fit : fitsOf(i, k))
        if ((fit.sound || fit.pairs > 1) && fit.overlap >= least_overlap && fit.evidence.agree >= least_agreement)
          joins.push_back({i, k, fit});
  std::stable_sort(joins.begin(), joins.end(),
                   [](const Join& x, const Join& y) { return x.fit.evidence.agree > y.fit.evidence.agree; });
  return joins;
}

bool Assembler::joinBest()
{
  findAllFits();
  for (const Join& candidate : likelyJoins()) {
    ClusterFit back = candidate.fit;
    back.T = back.T.inverse();
    if (hasAlias(candidate) || hasSecondPlace(candidate) ||
        fitsThird(candidate.first, candidate.second, candidate.fit) ||
        fitsThird(candidate.second, candidate.first, back)) {
      groups_[candidate.first].cluster.look_alike = groups_[candidate.second].cluster.look_alike = true;
      continue;
    }
    join(candidate);
    return true;
  }
  return false;
}

// The frame of the first group stays.
void Assembler::join(const Join& join)
{
  Group &first = groups_[join.first], &second = groups_[join.second];
  for (std::size_t k = 0; k < second.cluster.scans.size(); ++k) {
    first.cluster.scans.push_back(second.cluster.scans[k]);
    first.cluster.poses.push_back(join.fit.T * second.cluster.poses[k]);
  }
  first.id = next_id_++;
  groups_.erase(groups_.begin() + join.second);
  settle(input_, known_, first.cluster);
  for (Group& group : groups_)
    group.cluster.look_alike = false; // joinBest() tells anew
}

ScanGraph Assembler::run()
{
  while (joinBest())
    ;
  ScanGraph graph;
  for (const Group& group : groups_)
    graph.clusters.push_back(group.cluster);
  std::stable_sort(graph.clusters.begin() + (known_.scans.empty() ? 0 : 1), graph.clusters.end(),
                   [](const ScanCluster& x, const ScanCluster& y) { return x.scans.size() > y.scans.size(); });
  return graph;
}
} // namespace

ScanGraph assembleScans(const GraphInput& input, const ScanCluster& known) { return Assembler(input, known).run(); }
} // namespace fresco::registration
