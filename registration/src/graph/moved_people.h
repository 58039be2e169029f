// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
#include "scan/floor_plan.h"
namespace fresco::registration {
/// From now on people contradict no pose, nor what only rays of neighbouring directions saw through: surfaces that rays
/// graze may send nothing back.
/// @param frames of all scans; people are found in those that have one
void spareDoubtful(std::vector<PreparedScan>& scans, const PlanFrames& frames, int threads);

/// As before: all that lies in free space counts.
void spareNothing(std::vector<PreparedScan>& scans);

/// Whether people stood around, each time elsewhere: of the pairs whose best pose nothing else contradicts, a share is
/// contradicted by what may be people.
/// @param pairs aligned while scans spare what is doubtful
bool peopleMoved(std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs, int threads);
} // namespace fresco::registration
