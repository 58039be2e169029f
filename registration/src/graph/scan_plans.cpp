// SPDX-License-Identifier: BSD-3-Clause
#include "graph/scan_plans.h"
#include "graph/viewpoint_check.h"
#include <algorithm>
#include <fresco/core/parallel.h>
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
  parallelFor(
      frames.size(), threads,
      [&](Index k) {
        if (frames[k])
          plans[k] = PlanSpectrum(drawFloorPlan(scans[k], *frames[k], grid), *frames[k], grid);
      },
      1);
  return plans;
}
} // namespace fresco::registration
