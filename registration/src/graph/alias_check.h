// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// Largest violation of any scan of one cluster with any of the other, 0..1. Above max_violation it may be any value that
/// is: one contradiction decides.
double worstViolation(const GraphInput& input, const ScanCluster& first, const ScanCluster& second,
                      const Eigen::Isometry3d& T_first_second);

/// Whether the two clusters fit together elsewhere about as well by an alias of a scan of either.
/// @param T_first_second not contradicted by free space
bool hasAliasByScan(const GraphInput& input, const ScanCluster& first, const ScanCluster& second,
                    const Eigen::Isometry3d& T_first_second);
} // namespace fresco::registration
