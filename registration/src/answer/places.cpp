// SPDX-License-Identifier: BSD-3-Clause
#include "answer/places.h"
#include "pair/partial_alias.h"
#include "scan/lists.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::registration {
namespace {
// Frame of the first cluster from that of the second.
Eigen::Isometry3d clusterPose(const ScanCluster& first, const ScanCluster& second, const Place& place)
{
  return poseIn(first, place.a) * place.fit.T * poseIn(second, place.b).inverse();
}
} // namespace

PlaceFinder::PlaceFinder(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
                         const PlanPlaces& plan_places, const ScanRegistrationOptions& options)
    : scans_(scans), pairs_(pairs), plan_places_(plan_places), options_(options)
{}

Places PlaceFinder::ofPair(Index a, Index b) const
{
  Places places;
  for (const PairAlignment& pair : pairs_)
    if ((pair.a == a && pair.b == b) || (pair.a == b && pair.b == a))
      for (const VerifiedHypothesis& hypothesis : pair.hypotheses) {
        Place& place = places.emplace_back();
        place.a = a;
        place.b = b;
        place.number = places.size();
        place.fit.T = pair.a == a ? hypothesis.T_a_b : hypothesis.T_a_b.inverse();
        place.fit.overlap = hypothesis.check.overlap;
        place.violation = hypothesis.check.violation;
        place.score = hypothesis.score;
      }
  return places;
}

Place PlaceFinder::given(const RegistrationHint& hint) const
{
  Place place;
  place.a = hint.a;
  place.b = hint.b;
  Eigen::Isometry3d T(hint.T_a_b);
  T.linear() = normalized(T.linear());
  place.fit.T = Eigen::Translation3d(-scans_[hint.a].center) * T * Eigen::Translation3d(scans_[hint.b].center);
  return place;
}

Places PlaceFinder::ofClusters(const ScanCluster& cluster, const ScanCluster& moving, std::size_t most) const
{
  constexpr double distinct = 0.1; // of a scan's size
  Places all, places;
  for (const PairAlignment& pair : pairs_)
    for (const auto& [a, b] : {std::pair(pair.a, pair.b), std::pair(pair.b, pair.a)})
      if (contains(cluster, a) && contains(moving, b))
        for (const Place& place : ofPair(a, b))
          all.push_back(place);
  sortFalling(all, &Place::score);
  const auto add = [&](const Place& place, std::size_t limit) {
    const Eigen::Isometry3d T = clusterPose(cluster, moving, place) * moving.poses[0];
    const double size = scans_[moving.scans[0]].size;
    if (places.size() < limit && std::none_of(places.begin(), places.end(), [&](const Place& known) {
          return poseDistance(clusterPose(cluster, moving, known) * moving.poses[0], T, size) < distinct * size;
        }))
      places.push_back(place);
  };
  for (const Place& place : all)
    add(place, most);
  const std::size_t with_plans = places.size() + most;
  for (const PlanPlace& plan : plan_places_)
    for (const bool turned : {false, true}) {
      Place place;
      place.a = turned ? plan.b : plan.a;
      place.b = turned ? plan.a : plan.b;
      place.fit.T = turned ? plan.T_a_b.inverse() : plan.T_a_b;
      if (contains(cluster, place.a) && contains(moving, place.b))
        add(place, with_plans);
    }
  return places;
}

// Of a place that was found for whole clusters, the two scans that overlap most there.
void PlaceFinder::nameNearest(const ScanCluster& first, const ScanCluster& second, Place& place) const
{
  const Eigen::Isometry3d T = clusterPose(first, second, place);
  for (std::size_t i = 0; i < first.scans.size(); ++i)
    for (std::size_t k = 0; k < second.scans.size(); ++k) {
      const PreparedScan &a = scans_[first.scans[i]], &b = scans_[second.scans[k]];
      const Eigen::Isometry3d T_a_b = first.poses[i].inverse() * T * second.poses[k];
      if (T_a_b.translation().norm() > next_door * a.size)
        continue;
      const PairCheck check = checkRoughly(a, b, T_a_b, check_level);
      if (check.overlap <= place.fit.overlap)
        continue;
      place.a = first.scans[i];
      place.b = second.scans[k];
      place.fit.T = T_a_b;
      place.fit.overlap = check.overlap;
      place.violation = check.violation;
    }
}

bool PlaceFinder::see(Index a, Index b, const Eigen::Isometry3d& T_a_b) const
{
  return checkRoughly(scans_[a], scans_[b], T_a_b, check_level).overlap >= options_.min_overlap;
}

const RegistrationHint* PlaceFinder::forbids(const ScanCluster& cluster, const ScanCluster& moving,
                                             const Eigen::Isometry3d& T_cluster_moving) const
{
  for (const RegistrationHint& hint : options_.hints)
    for (const auto& [a, b] : {std::pair(hint.a, hint.b), std::pair(hint.b, hint.a)})
      if (hint.kind == HintKind::apart && contains(cluster, a) && contains(moving, b) &&
          see(a, b, poseIn(cluster, a).inverse() * T_cluster_moving * poseIn(moving, b)))
        return &hint;
  return nullptr;
}

void PlaceFinder::judge(const std::vector<ScanCluster>& clusters, const FreeSpaceJudge& judge, Places& places) const
{
  for (Place& place : places) {
    const ScanCluster &first = clusters[clusterOf(clusters, place.a)], &second = clusters[clusterOf(clusters, place.b)];
    place.fit.evidence = judge.judge(first, second, clusterPose(first, second, place));
    place.contradicted = isContradicted(place.fit.evidence);
    if (place.number == 0)
      nameNearest(first, second, place);
  }
  const auto is_forbidden = [&](const Place& place) {
    const ScanCluster &first = clusters[clusterOf(clusters, place.a)], &second = clusters[clusterOf(clusters, place.b)];
    return forbids(first, second, clusterPose(first, second, place)) != nullptr;
  };
  removeIf(places, is_forbidden);
  std::stable_sort(places.begin(), places.end(), [](const Place& x, const Place& y) {
    return x.contradicted != y.contradicted ? y.contradicted : x.fit.overlap > y.fit.overlap;
  });
}

Eigen::Matrix4d PlaceFinder::inFiles(const Place& place) const
{
  return (Eigen::Translation3d(scans_[place.a].center) * place.fit.T * Eigen::Translation3d(-scans_[place.b].center))
      .matrix();
}

CandidatePlace PlaceFinder::described(const Place& place) const
{
  CandidatePlace candidate;
  candidate.scan = place.b;
  candidate.beside = place.a;
  candidate.number = place.number;
  candidate.T_beside_scan = inFiles(place);
  candidate.overlap = place.fit.overlap;
  candidate.violation = place.violation;
  candidate.agree = place.fit.evidence.agree;
  candidate.contradict = place.fit.evidence.clustered;
  candidate.contradicted = place.contradicted;
  return candidate;
}

std::string PlaceFinder::line(const Place& place) const { return hintLine(described(place), options_); }
} // namespace fresco::registration
