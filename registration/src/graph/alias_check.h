// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// Two clusters that a pair of scans would join.
struct ClusterJoin {
  Index first = 0, second = 0; ///< clusters
  Eigen::Isometry3d T_first_second = Eigen::Isometry3d::Identity();
  double overlap = 0.0; ///< of the pair
};

/// Largest violation of any scan of one cluster with any of the other, 0..1. Above max_violation it may be any value that
/// is: one contradiction decides.
double worstViolation(const GraphInput& input, const ScanCluster& first, const ScanCluster& second,
                      const Eigen::Isometry3d& T_first_second);

/// Whether the same two clusters fit together elsewhere about as well, by a chain over a third cluster: of two equal
/// rooms, a scan that sees both shows that a cluster fits in either. High overlap with the one then says nothing against
/// the other; only what the scans saw through the doors does.
/// @param join not contradicted by free space
bool hasAliasByChain(const GraphInput& input, const std::vector<ScanCluster>& clusters, const ClusterJoin& join);

/// The same by an alias of a scan of either cluster.
bool hasAliasByScan(const GraphInput& input, const ScanCluster& first, const ScanCluster& second,
                    const Eigen::Isometry3d& T_first_second);
} // namespace fresco::registration
