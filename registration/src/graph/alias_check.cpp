// SPDX-License-Identifier: BSD-3-Clause
#include "graph/alias_check.h"
#include "scan/lists.h"
#include <algorithm>
#include <atomic>
namespace fresco::registration {
namespace {
// Motions of a cluster by the certain aliases of its scans, in its frame.
IsometryVector aliasMotions(const GraphInput& input, const ScanCluster& cluster)
{
  IsometryVector motions;
  for (std::size_t k = 0; k < cluster.scans.size(); ++k)
    for (const ScanAlias& alias : input.scans[cluster.scans[k]].aliases)
      if (alias.certain)
        for (const Eigen::Isometry3d& S : {alias.T, alias.T.inverse()})
          motions.push_back(cluster.poses[k] * S * cluster.poses[k].inverse());
  return motions;
}
} // namespace

double worstViolation(const GraphInput& input, const ScanCluster& first, const ScanCluster& second,
                      const Eigen::Isometry3d& T_first_second)
{
  const Index n = first.scans.size(), m = second.scans.size();
  std::atomic<bool> too_large{false};
  const std::vector<double> violations = mapTasks(n * m, input.options.threads, [&](Index k) {
    if (too_large)
      return 0.0;
    const Index i = k / m, j = k % m;
    const Eigen::Isometry3d T_a_b = first.poses[i].inverse() * T_first_second * second.poses[j];
    const double violation =
        pairViolation(input.scans[first.scans[i]], input.scans[second.scans[j]], T_a_b, check_level);
    if (violation > input.options.max_violation)
      too_large = true;
    return violation;
  });
  return *std::max_element(violations.begin(), violations.end());
}

bool hasAliasByScan(const GraphInput& input, const ScanCluster& first, const ScanCluster& second,
                    const Eigen::Isometry3d& T_first_second)
{
  IsometryVector elsewhere;
  for (const Eigen::Isometry3d& motion : aliasMotions(input, first))
    elsewhere.push_back(motion * T_first_second);
  for (const Eigen::Isometry3d& motion : aliasMotions(input, second))
    elsewhere.push_back(T_first_second * motion);
  if (elsewhere.empty())
    return false;
  const double size = input.scans[first.scans[0]].size, apart = std::max(3.0 * input.options.tolerance, 0.5 * size);
  const double here = worstViolation(input, first, second, T_first_second);
  return std::any_of(elsewhere.begin(), elsewhere.end(), [&](const Eigen::Isometry3d& T) {
    if (poseDistance(T, T_first_second, size) < apart)
      return false;
    const double there = worstViolation(input, first, second, T);
    return there <= input.options.max_violation && !clearlyWorse(there, here);
  });
}
} // namespace fresco::registration
