// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// Lets all pairs of a cluster count that say about what its poses say, where one pair at a time made them.
/// @param known scans that share a frame and do not move; may be empty
void closeLoops(const GraphInput& input, const ScanCluster& known, ScanCluster& cluster);

/// Moves all scans of a cluster so that their surfaces agree.
/// @param known scans that do not move; may be empty
void refineCluster(const GraphInput& input, const ScanCluster& known, ScanCluster& cluster);

/// The same after its loops are closed by what its pairs say.
void settle(const GraphInput& input, const ScanCluster& known, ScanCluster& cluster);

/// The place of a cluster near T in another one, by all its pairs with scans of that one, which does not move. One
/// thread.
Eigen::Isometry3d settledPose(const GraphInput& input, const ScanCluster& cluster, const ScanCluster& moving,
                              const Eigen::Isometry3d& T);
} // namespace fresco::registration
