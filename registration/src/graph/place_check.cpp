// SPDX-License-Identifier: BSD-3-Clause
#include "graph/place_check.h"
#include "graph/cluster_poses.h"
#include "refinement/joint_refinement.h"
#include "scan/lists.h"
#include <algorithm>
#include <cmath>
namespace fresco::registration {
namespace {
// Whether a place stands against another one. Overlap hardly counts: of equal rooms, the wrong one may be seen best.
bool contests(const ClusterPose& other, const ClusterPose& place)
{
  const double most = place.violating_points + 3.0 * std::sqrt(other.violating_points + place.violating_points);
  if (other.violating_points > most) // more than counts vary
    return false;
  if (other.sound && !other.chained && other.violation <= pane_violation)
    return true;
  return !clearlyWorse(other.violation, place.violation) &&
         (other.chained || other.overlap >= chance_share * place.overlap);
}

class PlaceSearch {
public:
  PlaceSearch(const GraphInput& input, const ScanCluster& cluster, const ScanCluster& moving)
      : input_(input), cluster_(cluster), moving_(moving), size_(input.scans[moving.scans[0]].size)
  {}

  ClusterPoses run() const;
  ClusterPose judged(ClusterPose place) const;
  double distance(const Eigen::Isometry3d& T, const Eigen::Isometry3d& other) const
  {
    return poseDistance(T * moving_.poses[0], other * moving_.poses[0], size_);
  }

private:
  // Errors of a pose that is not refined may cause it.
  double loose() const { return 0.5 * input_.options.max_violation; }
  // Right poses of little overlap are often below that from which a place is believed.
  double contestingColor() const { return input_.least_color * (input_.least_color > 0.0 ? 0.5 : 1.0); }
  void addPlaces(Index scan, Index from, const ClusterPose& pose, bool sound_only, ClusterPoses& places) const;
  ClusterPoses placesOf(Index scan, bool sound_only) const;
  void addChains(ClusterPoses& places) const;
  ClusterPoses roughPlaces() const;
  Eigen::Isometry3d refined(const Eigen::Isometry3d& T) const;
  bool isKnown(const ClusterPose& rough, double tolerances, ClusterPoses& places) const;

  const GraphInput& input_;
  const ScanCluster &cluster_, &moving_;
  double size_;
};

// Where a scan at a pose sees another one.
void PlaceSearch::addPlaces(Index scan, Index from, const ClusterPose& pose, bool sound_only,
                            ClusterPoses& places) const
{
  for (const PairAlignment* pair : input_.pairs_of[scan]) {
    if ((pair->a == scan ? pair->b : pair->a) != from)
      continue;
    for (const VerifiedHypothesis& hypothesis : pair->hypotheses) {
      const double color = hypothesis.check.color.value_or(1.0);
      const bool sound = isSound(*pair, hypothesis), faded = pose.faded || color < input_.least_color;
      if (color < contestingColor() || (sound_only ? !sound : hypothesis.check.violation > loose()))
        continue;
      const Eigen::Isometry3d& T = hypothesis.T_a_b;
      places.push_back({pose.T * (pair->a == scan ? T.inverse() : T), sound, pose.chained, faded});
    }
  }
}

// Of a scan among those of the cluster.
ClusterPoses PlaceSearch::placesOf(Index scan, bool sound_only) const
{
  ClusterPoses places;
  for (std::size_t k = 0; k < cluster_.scans.size(); ++k)
    addPlaces(scan, cluster_.scans[k], {cluster_.poses[k], false, sound_only, false}, sound_only, places);
  return places;
}

// Over one or two scans that are in neither cluster.
void PlaceSearch::addChains(ClusterPoses& places) const
{
  const Index n = input_.scans.size();
  std::vector<Index> outside;
  for (Index i = 0; i < n; ++i)
    if (input_.scans[i].problem.empty() && !contains(cluster_, i) && !contains(moving_, i))
      outside.push_back(i);
  std::vector<ClusterPoses> first(n);
  for (const Index i : outside)
    first[i] = placesOf(i, true);
  for (const Index i : outside) {
    ClusterPoses reached = first[i];
    for (const Index j : outside)
      for (const ClusterPose& place : first[j])
        addPlaces(i, j, place, true, reached);
    for (const ClusterPose& place : reached)
      for (std::size_t k = 0; k < moving_.scans.size(); ++k) {
        ClusterPoses ends;
        addPlaces(moving_.scans[k], i, place, true, ends);
        for (const ClusterPose& end : ends)
          places.push_back({end.T * moving_.poses[k].inverse(), end.sound, true, end.faded});
      }
  }
}

ClusterPoses PlaceSearch::roughPlaces() const
{
  ClusterPoses places;
  for (std::size_t k = 0; k < moving_.scans.size(); ++k)
    for (const ClusterPose& place : placesOf(moving_.scans[k], false))
      places.push_back({place.T * moving_.poses[k].inverse(), place.sound, false, place.faded});
  addChains(places);
  return places;
}

// What all pairs of their scans say of it.
ClusterPose PlaceSearch::judged(ClusterPose place) const
{
  const Eigen::Isometry3d& T = place.T;
  place.violation = place.overlap = 0.0;
  place.violating_points = 0;
  std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> near_first;
  for (std::size_t i = 0; i < cluster_.scans.size(); ++i)
    for (std::size_t j = 0; j < moving_.scans.size(); ++j)
      near_first.push_back({(cluster_.poses[i].translation() - (T * moving_.poses[j]).translation()).norm(), {i, j}});
  std::sort(near_first.begin(), near_first.end());
  Index against = 0, agree = 0;
  for (const auto& [distance, pair] : near_first) {
    const auto& [i, j] = pair;
    const PairCheck check =
        checkRoughly(input_.scans[cluster_.scans[i]], input_.scans[moving_.scans[j]],
                     cluster_.poses[i].inverse() * T * moving_.poses[j], check_level, Grazed::spared);
    place.violation = std::max(place.violation, check.violation);
    place.overlap = std::max(place.overlap, check.overlap);
    place.violating_points += check.violating_points;
    const bool contradicts = contradictsOneRoom(check, input_.usual_violation);
    against += contradicts ? 1 : 0;
    agree += !contradicts && check.overlap > strong_overlap ? 1 : 0;
    if (place.violation > loose())
      break; // ruled out
  }
  place.doubtful = against > 0 && against >= agree;
  return place;
}

// One scan alone moves; clusters of several are left as they are.
Eigen::Isometry3d PlaceSearch::refined(const Eigen::Isometry3d& T) const
{
  return moving_.scans.size() > 1 ? T : settledPose(input_, cluster_, moving_, T);
}

bool PlaceSearch::isKnown(const ClusterPose& rough, double tolerances, ClusterPoses& places) const
{
  for (ClusterPose& place : places)
    if (distance(place.T, rough.T) < tolerances * input_.options.tolerance) {
      place.sound = place.sound || rough.sound;
      place.chained = place.chained || rough.chained;
      place.faded = place.faded && rough.faded;
      return true;
    }
  return false;
}

ClusterPoses PlaceSearch::run() const
{
  ClusterPoses places;
  for (ClusterPose place : roughPlaces()) {
    if (isKnown(place, 2.0, places) || judged(place).violation > loose())
      continue;
    place.T = refined(place.T);
    if (isKnown(place, 1.0, places))
      continue;
    place = judged(place);
    if (place.violation <= loose())
      places.push_back(place);
  }
  return places;
}

// Members of which holds(others, member) says so.
template <typename Holds>
std::vector<Index> membersWhere(const GraphInput& input, const ScanCluster& cluster, const Holds& holds)
{
  const std::vector<char> found = mapTasks(cluster.scans.size(), input.options.threads, [&](Index k) {
    const auto [member, others] = divide(cluster, {cluster.scans[k]});
    return holds(others, member);
  });
  std::vector<Index> scans;
  for (std::size_t k = 0; k < found.size(); ++k)
    if (found[k])
      scans.push_back(cluster.scans[k]);
  return scans;
}
} // namespace

bool isContested(const GraphInput& input, const ScanCluster& cluster, const ScanCluster& moving,
                 const Eigen::Isometry3d& T)
{
  if (!std::all_of(moving.scans.begin(), moving.scans.end(), [&](Index scan) { return sawAround(input.scans[scan]); }))
    return false;
  const PlaceSearch search(input, cluster, moving);
  const ClusterPose here = search.judged({T});
  const ClusterPoses places = search.run();
  return here.doubtful || std::any_of(places.begin(), places.end(), [&](const ClusterPose& place) {
           return search.distance(place.T, T) > 2.0 * input.options.tolerance && contests(place, here);
         });
}

ClusterPoses findPlaces(const GraphInput& input, const ScanCluster& cluster, const ScanCluster& moving)
{
  return PlaceSearch(input, cluster, moving).run();
}

const ClusterPose* uncontested(const ClusterPoses& places, double least_overlap, double most_violation)
{
  for (const ClusterPose& place : places) {
    const bool contested = std::any_of(places.begin(), places.end(), [&](const ClusterPose& other) {
      return &other != &place && contests(other, place);
    });
    if (!contested && !place.doubtful && !place.faded && place.overlap >= least_overlap &&
        place.violation <= most_violation)
      return &place;
  }
  return nullptr;
}

std::vector<Index> contestedScans(const GraphInput& input, const ScanCluster& known, const ScanCluster& cluster)
{
  return membersWhere(input, cluster, [&](const ScanCluster& others, const ScanCluster& member) {
    return !others.scans.empty() && !contains(known, member.scans[0]) &&
           isContested(input, others, member, Eigen::Isometry3d::Identity());
  });
}
} // namespace fresco::registration
