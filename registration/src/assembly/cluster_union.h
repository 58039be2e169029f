// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/free_space_evidence.h"
namespace fresco::registration {
/// A cluster, those that it was united of, and each scan that only one graph brings.
struct JoinedCluster {
  ScanCluster cluster;
  std::vector<std::vector<Index>> parts;
};

/// Unites clusters of two graphs of the same scans where they share scans. A cluster of the second graph is left out if
/// it shares none: the first graph holds all that it joins undecided. It is left out, too, if it places any of the scans
/// that it shares elsewhere, or if free space contradicts what it would bring together.
/// @return every scan of the first graph in one cluster; its frames stay; not sorted
std::vector<JoinedCluster> uniteClusters(const GraphInput& input, const FreeSpaceJudge& judge, const ScanGraph& first,
                                         const ScanGraph& second);
} // namespace fresco::registration
