// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
#include <fresco/core/progress.h>
#include <fresco/registration/core/scan_registration.h>
namespace fresco::registration {
struct GlobalAlignment {
  ScanGraph graph;
  std::vector<PairAlignment> pairs; ///< that were tried, ordered by (a, b)
};

/// Joins scans without start poses to clusters in common frames. Pairs that look most alike are tried first; once all
/// scans hang together, no more are.
/// A scan of narrow view that contradicts most of its pairs by its free space has another viewpoint than was thought:
/// distrustViewpoint() is called on it.
/// @param known scans that already share a frame; they become one cluster, whose frame stays. May be empty.
GlobalAlignment alignGlobally(std::vector<PreparedScan>& scans, const ScanCluster& known,
                              const ScanRegistrationOptions& options, const Progress& progress);
} // namespace fresco::registration
