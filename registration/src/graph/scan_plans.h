// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
#include "pair/plan_correlation.h"
namespace fresco::registration {
/// Of the floor plans of scans: where all scanners saw around, and their files or points tell from where; else empty.
/// @param known scans that share a frame: then none are drawn
PlanFrames knownFrames(const std::vector<PreparedScan>& scans, const ScanCluster& known, int threads);

/// The floor plans of all scans, empty where there is none.
/// @param frames cleared where no plan can be drawn
std::vector<PlanSpectrum> drawPlans(const std::vector<PreparedScan>& scans, PlanFrames& frames, int threads);
} // namespace fresco::registration
