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

enum class Likeness { none, together, apart };

// Whether two scans agree nearly everywhere, and if so, whether they lie in one cluster as they do then.
Likeness likenessOf(const PairAlignment& pair, const GraphInput& input, const std::vector<ScanCluster>& clusters,
                    const std::vector<ClusterPlace>& places)
{
  const ClusterPlace &a = places[pair.a], &b = places[pair.b];
  const ScanCluster& cluster = clusters[a.cluster];
  Likeness likeness = Likeness::none;
  for (const VerifiedHypothesis& hypothesis : pair.hypotheses) {
    if (hypothesis.check.overlap < twin_overlap || hypothesis.check.color) // colours tell rooms apart themselves
      continue;
    const bool together = a.cluster == b.cluster &&
                          poseDistance(cluster.poses[a.position].inverse() * cluster.poses[b.position],
                                       hypothesis.T_a_b, input.scans[pair.a].size) < 3.0 * input.options.tolerance;
    if (together)
      return Likeness::together;
    likeness = Likeness::apart;
  }
  return likeness;
}
} // namespace

void partEqualRooms(const GraphInput& input, const ScanCluster& known, std::vector<ScanCluster>& clusters)
{
  const std::vector<ClusterPlace> places = placesOf(clusters, input.scans.size());
  std::map<Index, Index> twins; // scan, another one of its cluster
  Index apart = 0;
  for (const PairAlignment& pair : input.pairs) {
    const Likeness likeness = likenessOf(pair, input, clusters, places);
    apart += likeness == Likeness::apart ? 1 : 0;
    if (likeness != Likeness::together)
      continue;
    twins.emplace(pair.a, pair.b);
    twins.emplace(pair.b, pair.a);
  }
  if (apart == 0 || 2 * apart < countUsable(input.scans))
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
