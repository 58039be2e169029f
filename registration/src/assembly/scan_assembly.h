// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// Joins scans to clusters by the free space of whole clusters. Of all places of one cluster in another that pairs of
/// their scans lead to, the one where most surfaces agree is tried first. Clusters are not joined where free space
/// contradicts it, or while one of them also fits elsewhere: at a second place in the other, or in a third cluster in
/// a way that contradicts the join. In the end, parts of clusters that equal rooms leave undecided are split off. Every
/// usable scan has free space and saw around, and no two share a frame from the start.
ScanGraph assembleScans(const GraphInput& input);
} // namespace fresco::registration
