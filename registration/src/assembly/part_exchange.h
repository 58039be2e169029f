// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// Takes each part of a join out of its cluster again, as long as it is no more than half of it, and tries it at the
/// other places in the rest that pairs of scans lead to, and by motions from a room to an equal one, which two places
/// of another cluster show: what was joined first may be doubtful by what joined later. Parts with a second place
/// become clusters of their own. Scans of `known` stay. Every usable scan has free space.
/// @param graph clusters are largest first after it, but that of `known` before all
void partSecondPlaces(const GraphInput& input, const ScanCluster& known, ScanGraph& graph);
} // namespace fresco::registration
