// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/scan_assembly.h"
#include "assembly/cluster_fits.h"
#include "graph/alias_check.h"
#include "graph/cluster_poses.h"
#include "scan/lists.h"
#include <algorithm>
namespace fresco::registration {
namespace {
// Whether what pairs say of another place is as sure as what they say of a join.
bool isAsSure(const ClusterFit& other, const ClusterFit& join)
{
  return other.certain || (other.sound && !join.certain);
}

class Assembler {
public:
  explicit Assembler(const GraphInput& input) : input_(input), judge_(input.scans), fitter_(input, judge_)
  {
    for (const ScanCluster& cluster : startingClusters(input_, {}))
      groups_.push_back({next_id_++, cluster});
  }

  void joinAll()
  {
    while (joinBest())
      ;
  }
  ScanGraph graph() const;

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

  void findAllFits();
  // Of the second group in the first.
  ClusterFits fitsOf(std::size_t first, std::size_t second) const
  {
    return fits_.of(groups_[first].id, groups_[second].id);
  }
  RefusalReason refusal(const Join& candidate) const;
  bool hasSecondPlace(const Join& join) const;
  bool fitsThird(std::size_t stays, std::size_t moves, const ClusterFit& fit) const;
  bool yields(std::size_t stays, std::size_t moves, std::size_t third, const ClusterFit& moved,
              const ClusterFit& other) const;
  Joins likelyJoins() const;
  bool joinBest();
  void join(const Join& join);

  const GraphInput& input_;
  FreeSpaceJudge judge_;
  ClusterFitter fitter_;
  std::vector<Group> groups_;
  std::vector<std::vector<Index>> parts_; // scans of groups that were joined
  Index next_id_ = 0;
  GroupFits<ClusterFits> fits_;
};

void Assembler::findAllFits()
{
  fits_.findNew(groups_, input_.options.threads,
                [&](const Group& first, const Group& second) { return fitter_.find(first.cluster, second.cluster); });
}

bool Assembler::hasSecondPlace(const Join& join) const
{
  const ClusterFits fits = fitsOf(join.first, join.second);
  return std::any_of(fits.begin(), fits.end(), [&](const ClusterFit& other) {
    return !fitter_.isSame(groups_[join.second].cluster, other.T, join.fit.T, 3.0) &&
           rivals(other, join.fit, judge_.unit());
  });
}

// Whether a group that moves has a place in a third one, and the first and the third cannot both be where that leads to.
bool Assembler::fitsThird(std::size_t stays, std::size_t moves, const ClusterFit& fit) const
{
  const auto are_apart = [&](std::size_t third, const ClusterFit& other) {
    return isContradicted(judge_.judge(groups_[stays].cluster, groups_[third].cluster, fit.T * other.T.inverse()));
  };
  for (std::size_t third = 0; third < groups_.size(); ++third) {
    if (third == stays || third == moves)
      continue;
    for (const ClusterFit& other : fitsOf(third, moves))
      if (isAsSure(other, fit) && rivals(other, fit, judge_.unit()) && are_apart(third, other) &&
          !yields(stays, moves, third, fit, other))
        return true;
  }
  return false;
}

// Whether the third group's claim to what moves yields to a certain fit where more is confirmed: if the third group
// fits as well in a fourth one that cannot be there, it is explained without the claim.
bool Assembler::yields(std::size_t stays, std::size_t moves, std::size_t third, const ClusterFit& moved,
                       const ClusterFit& other) const
{
  if (!moved.certain || moved.evidence.confirmed <= other.evidence.confirmed)
    return false;
  for (std::size_t home = 0; home < groups_.size(); ++home) {
    if (home == stays || home == moves || home == third)
      continue;
    for (const ClusterFit& own : fitsOf(home, third))
      if (own.certain && rivals(own, other, judge_.unit()) &&
          isContradicted(judge_.judge(groups_[home].cluster, groups_[moves].cluster, own.T * other.T)))
        return true;
  }
  return false;
}

// What most confirms first.
Assembler::Joins Assembler::likelyJoins() const
{
  Joins joins;
  for (std::size_t i = 0; i < groups_.size(); ++i)
    for (std::size_t k = i + 1; k < groups_.size(); ++k)
      for (const ClusterFit& fit : fitsOf(i, k))
        if (isJoinable(fit))
          joins.push_back({i, k, fit});
  sortFalling(joins, [](const Join& join) { return join.fit.evidence.confirmed; });
  return joins;
}

RefusalReason Assembler::refusal(const Join& candidate) const
{
  if (hasAliasByScan(input_, groups_[candidate.first].cluster, groups_[candidate.second].cluster, candidate.fit.T))
    return RefusalReason::repeats;
  if (hasSecondPlace(candidate))
    return RefusalReason::second_place;
  return fitsThird(candidate.first, candidate.second, candidate.fit) ||
                 fitsThird(candidate.second, candidate.first, reversed(candidate.fit))
             ? RefusalReason::claimed
             : RefusalReason::none;
}

bool Assembler::joinBest()
{
  findAllFits();
  for (const Join& candidate : likelyJoins()) {
    const RefusalReason reason = refusal(candidate);
    if (reason == RefusalReason::none) {
      join(candidate);
      return true;
    }
    refuse(groups_[candidate.first].cluster, groups_[candidate.second].cluster, reason, candidate.fit.evidence);
  }
  return false;
}

// The frame of the first group stays.
void Assembler::join(const Join& join)
{
  Group &first = groups_[join.first], &second = groups_[join.second];
  parts_.push_back(first.cluster.scans);
  parts_.push_back(second.cluster.scans);
  append(first.cluster, second.cluster, join.fit.T);
  first.id = next_id_++;
  groups_.erase(groups_.begin() + join.second);
  settle(input_, {}, first.cluster);
  for (Group& group : groups_)
    group.cluster.refusal = {}; // joinBest() tells anew
}

ScanGraph Assembler::graph() const
{
  ScanGraph graph;
  graph.parts = parts_;
  for (const Group& group : groups_)
    graph.clusters.push_back(group.cluster);
  sortBySize(graph.clusters, 0);
  return graph;
}
} // namespace

ScanGraph assembleScans(const GraphInput& input)
{
  Assembler assembler(input);
  assembler.joinAll();
  return assembler.graph();
}

} // namespace fresco::registration
