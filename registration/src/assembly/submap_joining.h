// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "assembly/submap.h"
#include "graph/free_space_evidence.h"
#include <fresco/core/progress.h>
namespace fresco::registration {
/// Joins clusters as wholes where no pair of their scans tells: all places of one in another that their floor plans
/// lead to are looked at. The best joins if it is clearly the best, and if neither cluster has a place in a third one
/// that stands against it. Clusters are largest first, before and after.
/// Every usable scan has free space and saw around.
/// @param frames of the floor plans; a cluster takes part if one of its scans has a frame
void joinSubmaps(const GraphInput& input, const PlanFrames& frames, ScanGraph& graph, const Progress& progress);
} // namespace fresco::registration
