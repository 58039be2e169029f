// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// Two clusters that a pair of scans would join.
struct ClusterJoin {
  std::size_t first = 0, second = 0; ///< clusters
  Eigen::Isometry3d T_first_second = Eigen::Isometry3d::Identity();
  double overlap = 0.0; ///< of the pair
};

/// Larger violation of any scan of one cluster with any of the other, 0..1.
double worstViolation(const std::vector<PreparedScan>& scans, const ScanCluster& first, const ScanCluster& second,
                      const Eigen::Isometry3d& T_first_second, int threads);

/// Whether the same two clusters fit together elsewhere about as well, by way of a third cluster: a room that has a
/// twin. If a scan sees two places that a cluster fits in, high overlap with the one says nothing against the other;
/// only what the scans saw through the doors does.
/// @param join not contradicted by free space
bool isContested(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
                 const std::vector<ScanCluster>& clusters, const ClusterJoin& join, const GraphOptions& options);

/// The same by way of a place that a scan of either cluster saw twice.
bool hasTwin(const std::vector<PreparedScan>& scans, const std::vector<ScanCluster>& clusters, const ClusterJoin& join,
             const GraphOptions& options);
} // namespace fresco::registration
