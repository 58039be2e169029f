// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
#include "pair/plan_correlation.h"
namespace fresco::registration {
/// A cluster of scans as one: its surfaces, and where its floor plan is drawn.
struct Submap {
  PreparedScan surface;         ///< all scans together, at two resolutions, in the frame of the cluster
  std::vector<PlanScan> placed; ///< in the plan, whose origin is the middle of the cluster
  PlanFrame frame;              ///< from the frame of the cluster
  float extent = 0.f;           ///< of the plan along its longer side, length
};

/// @return nothing unless one of its scans has a frame
std::optional<Submap> makeSubmap(const std::vector<PreparedScan>& scans, const PlanFrames& frames,
                                 const ScanCluster& cluster);

/// Where the second may be in the first: where their floor plans lie on each other best, right to a few decimetres.
/// What pairs of scans tell takes no part, so places are found that no pair of scans overlaps enough to tell.
/// @return frame of the first from that of the second, the likeliest first
IsometryVector matchSubmaps(const Submap& first, const Submap& second, std::size_t most);

/// A place near T, by point-to-plane registration of all surfaces of both. One thread.
Eigen::Isometry3d refineSubmap(const Submap& first, const Submap& second, const Eigen::Isometry3d& T);
} // namespace fresco::registration
