// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/submap_joining.h"
#include "assembly/cluster_fits.h"
#include "graph/cluster_poses.h"
#include "scan/lists.h"
#include <algorithm>
#include <memory>
namespace fresco::registration {
namespace {
constexpr double least_confirmed = 1.5; // of one scan's points; at less, wrong places are found without a rival, too

class SubmapJoiner {
public:
  SubmapJoiner(const GraphInput& input, const PlanFrames& frames)
      : input_(input), frames_(frames), judge_(input.scans), fitter_(input, judge_)
  {}

  void run(ScanGraph& graph, const Progress& progress);

private:
  struct Group {
    Index id;
    ScanCluster cluster;
    std::shared_ptr<const std::optional<Submap>> submap;
  };
  struct Join {
    std::size_t first, second; // groups, the larger one first
    ClusterFit place;
  };
  using Joins = std::vector<Join, Eigen::aligned_allocator<Join>>;

  void add(const ScanCluster& cluster);
  ClusterFits findPlaces(const Group& first, const Group& second) const;
  // Of the second group in the first; best first.
  ClusterFits placesOf(std::size_t first, std::size_t second) const
  {
    return places_.of(groups_[first].id, groups_[second].id);
  }
  Joins likelyJoins() const;
  bool fitsThird(std::size_t stays, std::size_t moves, const ClusterFit& place) const;
  Joins soundJoins();
  void join(const Joins& joins);

  const GraphInput& input_;
  const PlanFrames& frames_;
  FreeSpaceJudge judge_;
  ClusterFitter fitter_;
  std::vector<Group> groups_;
  std::vector<std::vector<Index>> parts_; // scans of groups that were joined
  Index next_id_ = 0;
  GroupFits<ClusterFits> places_;
};

void SubmapJoiner::add(const ScanCluster& cluster)
{
  constexpr std::size_t most_scans = 40; // above, a group costs as much as all pairs of its scans did
  auto submap = std::make_shared<std::optional<Submap>>();
  if (cluster.scans.size() <= most_scans)
    *submap = makeSubmap(input_.scans, frames_, cluster);
  groups_.push_back({next_id_++, cluster, submap});
}

// By floor plans, and by what pairs of scans tell.
ClusterFits SubmapJoiner::findPlaces(const Group& first, const Group& second) const
{
  constexpr std::size_t most_of_groups = 32; // of 30 true places 22 are among the first 24, of 28 23 among 64
  const auto uncontradicted = [&](const ClusterFits& rough) {
    return fitter_.uncontradicted(first.cluster, second.cluster, rough);
  };
  ClusterFits fits = uncontradicted(fitter_.rough(first.cluster, second.cluster)), by_plans;
  const std::optional<Submap>&a = *first.submap, &b = *second.submap;
  if (a && b && first.cluster.scans.size() + second.cluster.scans.size() > 2) // of two scans the pair has told all
    for (const Eigen::Isometry3d& T : matchSubmaps(*a, *b, most_of_groups))
      if (!isHopeless(judge_.judge(first.cluster, second.cluster, T)))
        by_plans.emplace_back().T = refineSubmap(*a, *b, T);
  for (const ClusterFit& fit : uncontradicted(by_plans))
    if (std::none_of(fits.begin(), fits.end(), [&](const ClusterFit& known) {
          return fitter_.isSame(second.cluster, known.T, fit.T, near_tolerances);
        }))
      fits.push_back(fit);
  removeIf(fits, [](const ClusterFit& fit) { return fit.evidence.confirmed < chance_share * least_confirmed; });
  sortFalling(fits, [](const ClusterFit& fit) { return fit.evidence.confirmed; });
  return fits;
}

// Places without a rival between the same groups, most points first. Two single scans stay as their pair has left them.
SubmapJoiner::Joins SubmapJoiner::likelyJoins() const
{
  Joins joins;
  for (std::size_t i = 0; i < groups_.size(); ++i)
    for (std::size_t k = i + 1; k < groups_.size(); ++k) {
      const ClusterFits places = placesOf(i, k);
      if (groups_[i].cluster.scans.size() + groups_[k].cluster.scans.size() > 2 && !places.empty() &&
          places[0].evidence.confirmed >= least_confirmed &&
          (places.size() == 1 || places[1].evidence.confirmed < chance_share * places[0].evidence.confirmed))
        joins.push_back(groups_[i].cluster.scans.size() >= groups_[k].cluster.scans.size()
                            ? Join{i, k, places[0]}
                            : Join{k, i, reversed(places[0])});
    }
  sortFalling(joins, [](const Join& join) { return join.place.evidence.confirmed; });
  return joins;
}

// Whether a group that moves has a place in a third one, and free space contradicts the first and the third where that
// leads to. What the third confirms less than at a place that agrees with the join is explained by that one.
bool SubmapJoiner::fitsThird(std::size_t stays, std::size_t moves, const ClusterFit& place) const
{
  const auto agrees = [&](std::size_t third, const ClusterFit& other) {
    return !isContradicted(judge_.judge(groups_[stays].cluster, groups_[third].cluster, place.T * other.T.inverse()));
  };
  for (std::size_t third = 0; third < groups_.size(); ++third) {
    if (third == stays || third == moves)
      continue;
    const ClusterFits others = placesOf(third, moves);
    if (!others.empty() && others[0].evidence.confirmed >= chance_share * place.evidence.confirmed &&
        !agrees(third, others[0]))
      return true;
  }
  return false;
}

// Of all likely joins those that stand together: a group that moves takes part in one only.
SubmapJoiner::Joins SubmapJoiner::soundJoins()
{
  std::vector<char> stays(groups_.size(), 0), moves(groups_.size(), 0);
  Joins accepted;
  for (const Join& candidate : likelyJoins()) {
    if (moves[candidate.first] || moves[candidate.second] || stays[candidate.second])
      continue;
    if (fitsThird(candidate.first, candidate.second, candidate.place) ||
        fitsThird(candidate.second, candidate.first, reversed(candidate.place))) {
      refuse(groups_[candidate.first].cluster, groups_[candidate.second].cluster, RefusalReason::claimed,
             candidate.place.evidence);
      continue;
    }
    stays[candidate.first] = moves[candidate.second] = 1;
    accepted.push_back(candidate);
  }
  return accepted;
}

// The larger groups stay.
void SubmapJoiner::join(const Joins& joins)
{
  std::vector<ScanCluster> grown(groups_.size());
  std::vector<char> moved(groups_.size(), 0);
  for (const Join& join : joins) {
    ScanCluster& cluster = grown[join.first];
    if (cluster.scans.empty())
      cluster = groups_[join.first].cluster;
    parts_.push_back(cluster.scans);
    parts_.push_back(groups_[join.second].cluster.scans);
    append(cluster, groups_[join.second].cluster, join.place.T);
    moved[join.second] = 1;
  }
  std::vector<Group> before = std::move(groups_);
  groups_.clear();
  for (std::size_t g = 0; g < before.size(); ++g)
    if (!moved[g] && grown[g].scans.empty())
      groups_.push_back(std::move(before[g]));
  for (std::size_t g = 0; g < before.size(); ++g)
    if (!grown[g].scans.empty()) {
      grown[g].refusal = {};
      refineCluster(input_, before[g].cluster, grown[g]);
      add(grown[g]);
    }
}

void SubmapJoiner::run(ScanGraph& graph, const Progress& progress)
{
  for (const ScanCluster& cluster : graph.clusters)
    add(cluster);
  for (;;) {
    report(progress, "join groups", 0.9);
    places_.findNew(groups_, input_.options.threads,
                    [&](const Group& first, const Group& second) { return findPlaces(first, second); });
    const Joins joins = soundJoins();
    if (joins.empty())
      break;
    join(joins);
  }
  graph.parts.insert(graph.parts.end(), parts_.begin(), parts_.end());
  graph.clusters.clear();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const ScanCluster& cluster = graph.clusters.emplace_back(groups_[g].cluster);
    for (std::size_t k = 0; k < g; ++k)
      for (const ClusterFit& place : placesOf(k, g))
        graph.places.push_back({groups_[k].cluster.scans[0], cluster.scans[0],
                                groups_[k].cluster.poses[0].inverse() * place.T * cluster.poses[0]});
  }
  sortBySize(graph.clusters, 0);
}
} // namespace

void joinSubmaps(const GraphInput& input, const PlanFrames& frames, ScanGraph& graph, const Progress& progress)
{
  if (graph.clusters.size() > 1)
    SubmapJoiner(input, frames).run(graph, progress);
}
} // namespace fresco::registration
