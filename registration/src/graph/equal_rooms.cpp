// SPDX-License-Identifier: BSD-3-Clause
#include "graph/equal_rooms.h"
#include "scan/lists.h"
#include <algorithm>
#include <fresco/registration/core/sc2_pcr.h>
#include <map>
namespace fresco::registration {
namespace {
// Overlap of two scans of one room, or of equal rooms: all but what is seen through doors and behind furniture.
constexpr double twin_overlap = 0.9;

// Of the median range: no two stations of a survey stand nearer, unless one place was measured twice.
constexpr double least_spacing = 0.25, one_place = 0.05;

enum class Likeness { none, together, crowded, apart };

// Whether two scans agree nearly everywhere, and if so, whether they lie in one cluster as they do then: at the distance of
// stations, or crowded as if rooms had fallen into one.
Likeness likenessOf(const PairAlignment& pair, const GraphInput& input, const std::vector<ScanCluster>& clusters,
                    const std::vector<ClusterPlace>& places)
{
  const ClusterPlace &at_a = places[pair.a], &at_b = places[pair.b];
  const PreparedScan &a = input.scans[pair.a], &b = input.scans[pair.b];
  const ScanCluster& cluster = clusters[at_a.cluster];
  Likeness likeness = Likeness::none;
  for (const VerifiedHypothesis& hypothesis : pair.hypotheses) {
    if (hypothesis.check.overlap < twin_overlap || hypothesis.check.color) // colours tell rooms apart themselves
      continue;
    const double distance = hypothesis.T_a_b.translation().norm();
    const bool crowded =
        sawAround(a) && sawAround(b) && distance > one_place * a.size && distance < least_spacing * a.size;
    if (at_a.cluster == at_b.cluster &&
        poseDistance(cluster.poses[at_a.position].inverse() * cluster.poses[at_b.position], hypothesis.T_a_b, a.size) <
            3.0 * input.options.tolerance)
      return crowded ? Likeness::crowded : Likeness::together;
    likeness = Likeness::apart;
  }
  return likeness;
}
} // namespace

void partEqualRooms(const GraphInput& input, const ScanCluster& known, std::vector<ScanCluster>& clusters)
{
  const std::vector<ClusterPlace> places = placesOf(clusters, input.scans.size());
  std::map<Index, Index> twins; // scan, another one of its cluster
  Index repeats = 0;
  for (const PairAlignment& pair : input.pairs) {
    const Likeness likeness = likenessOf(pair, input, clusters, places);
    repeats += likeness == Likeness::apart || likeness == Likeness::crowded ? 1 : 0;
    if (likeness != Likeness::together && likeness != Likeness::crowded)
      continue;
    twins.emplace(pair.a, pair.b);
    twins.emplace(pair.b, pair.a);
  }
  if (repeats == 0 || 2 * repeats < countUsable(input.scans))
    return;
  for (const auto& [scan, other] : twins) {
    if (contains(known, scan))
      continue;
    ScanCluster& cluster = clusters[places[scan].cluster];
    const Refusal refusal = cluster.refusal;
    cluster = divide(cluster, {scan}).second;
    cluster.refusal = refusal;
    clusters.push_back({{scan}, {Eigen::Isometry3d::Identity()}, {RefusalReason::repeats, other}});
  }
  removeIf(clusters, [](const ScanCluster& cluster) { return cluster.scans.empty(); });
  sortBySize(clusters, known.scans.empty() ? 0 : 1);
}
} // namespace fresco::registration
