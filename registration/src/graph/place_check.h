// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// Where one cluster may be in another.
struct ClusterPose {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity(); ///< frame of the other from its own
  bool sound = false;     ///< the best that a pair of scans says of itself, and nothing that they see contradicts it
  bool chained = false;   ///< by sound pairs over one or two scans of neither
  bool faded = false;     ///< by pairs whose colours agree too little to believe them, but enough to contest others
  double violation = 0.0; ///< largest of a scan of one with a scan of the other, 0..1
  double overlap = 0.0;   ///< likewise
  Index violating_points = 0; ///< of all pairs, see PairCheck
  bool doubtful = false;      ///< no more pairs agree there than contradict each other, see contradictsOneRoom()
};
using ClusterPoses = std::vector<ClusterPose, Eigen::aligned_allocator<ClusterPose>>;

/// All places of a cluster in another one that a pair of their scans, or a chain of pairs over other scans, leads to and
/// that free space does not rule out; refined, distinct.
ClusterPoses findPlaces(const GraphInput& input, const ScanCluster& cluster, const ScanCluster& moving);

/// Whether a cluster also fits elsewhere in another one than at T, or most scans contradict those of the same room there.
bool isContested(const GraphInput& input, const ScanCluster& cluster, const ScanCluster& moving,
                 const Eigen::Isometry3d& T);

/// The one that no other contests, if there is one that suffices.
/// @param most_violation of it
const ClusterPose* uncontested(const ClusterPoses& places, double least_overlap, double most_violation);

/// Members of a cluster whose places among its other scans are contested.
/// @param known scans that are not asked
std::vector<Index> contestedScans(const GraphInput& input, const ScanCluster& known, const ScanCluster& cluster);
} // namespace fresco::registration
