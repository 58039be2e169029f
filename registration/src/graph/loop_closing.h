// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// Lets all pairs of a cluster count that say about what its poses say, where one pair at a time made them.
/// @param known scans that share a frame and do not move; may be empty
void closeLoops(const GraphInput& input, const ScanCluster& known, ScanCluster& cluster);
} // namespace fresco::registration
