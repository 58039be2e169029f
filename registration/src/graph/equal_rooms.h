// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// In a building that repeats its rooms, makes alone what agrees nearly everywhere with another scan of its cluster: each
/// may be in a room of its own. Rooms repeat if the pairs of scans that agree nearly everywhere at some pose, but either
/// are not together so or stand nearer than stations do, number at least half the scans.
/// @param known its scans stay
void partEqualRooms(const GraphInput& input, const ScanCluster& known, std::vector<ScanCluster>& clusters);
} // namespace fresco::registration
