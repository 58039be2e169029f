// SPDX-License-Identifier: BSD-3-Clause
#include "graph/scan_plans.h"
#include "graph/viewpoint_check.h"
#include "scan/lists.h"
#include <algorithm>
namespace fresco::registration {
PlanFrames knownFrames(const std::vector<PreparedScan>& scans, const ScanCluster& known, int threads)
{
  const auto known_view = [](const PreparedScan& scan) {
    return !scan.problem.empty() || (sawAround(scan) && knowsViewpoint(scan));
  };
  if (!known.scans.empty() || !std::all_of(scans.begin(), scans.end(), known_view))
    return {};
  return findPlanFrames(scans, threads);
}

std::vector<PlanSpectrum> drawPlans(const std::vector<PreparedScan>& scans, PlanFrames& frames, int threads)
{
  std::vector<PlanSpectrum> plans(scans.size());
  const PlanGrid grid = choosePlanGrid(frames, scans);
  if (grid.side == 0)
    frames.clear();
  forEachTask(frames.size(), threads, [&](Index k) {
    if (frames[k])
      plans[k] = PlanSpectrum(drawFloorPlan({{scans[k], frames[k]->T_plan_scan}}, grid), *frames[k], grid);
  });
  return plans;
}
} // namespace fresco::registration
