// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "assembly/cluster_fits.h"
namespace fresco::registration {
/// Where one scan, and what hangs together with it, may be beside another one.
struct Place {
  Index a = 0, b = 0; ///< scans
  Index number = 0;   ///< in the list of what the two allow, from 1; 0 = not in it
  ClusterFit fit;     ///< T is a from b, working frames; evidence is that of all scans of both clusters
  double violation = 0.0, score = 0.0;
  bool contradicted = false; ///< see isContradicted()
};
using Places = std::vector<Place, Eigen::aligned_allocator<Place>>;

/// All that was found, whatever decided against it.
class PlaceFinder {
public:
  /// All have to outlive it.
  PlaceFinder(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
              const PlanPlaces& plan_places, const ScanRegistrationOptions& options);

  /// Of scan b at a: in the order in which hints count them.
  Places ofPair(Index a, Index b) const;

  /// What a hint `relative` says.
  Place given(const RegistrationHint& hint) const;

  /// Of a cluster in another one, distinct, the likeliest by their pairs first: so many of pairs, and as many of floor plans of
  /// both clusters.
  Places ofClusters(const ScanCluster& cluster, const ScanCluster& moving, std::size_t most = 6) const;

  /// What all scans of their clusters say, without places that hints forbid; most overlap of two scans first, what is contradicted last: floors and long walls
  /// agree wherever many scans are.
  void judge(const std::vector<ScanCluster>& clusters, const FreeSpaceJudge& judge, Places& places) const;

  /// Whether two scans overlap enough to be a pair.
  bool see(Index a, Index b, const Eigen::Isometry3d& T_a_b) const;

  /// The hint that keeps apart two scans which would see each other if the second cluster were there; null = none.
  const RegistrationHint* forbids(const ScanCluster& cluster, const ScanCluster& moving,
                                  const Eigen::Isometry3d& T_cluster_moving) const;

  /// The line of a hints file that takes a place.
  std::string line(const Place& place) const;
  CandidatePlace described(const Place& place) const; ///< but for its group

private:
  void nameNearest(const ScanCluster& first, const ScanCluster& second, Place& place) const;
  Eigen::Matrix4d inFiles(const Place& place) const;
  const std::vector<PreparedScan>& scans_;
  const std::vector<PairAlignment>& pairs_;
  const PlanPlaces& plan_places_;
  const ScanRegistrationOptions& options_;
};
} // namespace fresco::registration
