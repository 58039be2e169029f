// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
#include "graph/viewpoint_check.h"
#include <fresco/core/exchange.h>
namespace fresco::registration {
/// What the search of pairs and clusters found.
struct GlobalAlignment {
  ScanGraph graph;
  std::vector<PairAlignment> pairs;    ///< that were tried, ordered by (a, b)
  std::vector<ViewpointSign> signs;    ///< of each scan
  std::vector<std::string> distrusted; ///< per scan, why its viewpoint turned out wrong; empty = it did not
  std::vector<ScanAliases> aliases;    ///< of each scan
  bool people_moved = false;           ///< see spareDoubtful()
};

struct AlignmentInput {
  std::vector<PreparedScan>& scans;
  const ScanCluster&
      known;       ///< scans that already share a frame; they become one cluster, whose frame stays. May be empty
  Exchange& ranks; ///< that share out scans and pairs
};
} // namespace fresco::registration
