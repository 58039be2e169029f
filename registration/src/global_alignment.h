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

struct AlignmentInput {
  std::vector<PreparedScan>& scans;
  const ScanCluster&
      known;       ///< scans that already share a frame; they become one cluster, whose frame stays. May be empty
  Exchange& ranks; ///< that share out scans and pairs
};

/// Joins scans without start poses to clusters in common frames. Pairs that look most alike are tried first; once all
/// scans hang together, no more are.
/// A scan of narrow view that contradicts most of its pairs by its free space has another viewpoint than was thought:
/// distrustViewpoint() is called on it.
GlobalAlignment alignGlobally(const AlignmentInput& input, const ScanRegistrationOptions& options,
                              const Progress& progress);
} // namespace fresco::registration
