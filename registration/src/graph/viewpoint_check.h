// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
namespace fresco::registration {
/// Whether its file tells where it was seen from, or its points do.
inline bool knowsViewpoint(const PreparedScan& scan) { return scan.viewpoint_given || scan.viewpoint_found; }

/// What the points of a scan show of a viewpoint that no file tells.
enum class ViewpointSign : char {
  none,     ///< nothing, or it is known
  center,   ///< the scanner stood at the scan's centre, its frame's origin
  elsewhere ///< it stood somewhere else
};

/// Asked of scans of wide view whose frame's origin is taken for the scanner since no file says otherwise; some 0.3 s.
ViewpointSign findViewpointSign(const PreparedScan& scan, int threads);

/// From then on viewpoints count as found where the points show them. Scans of one source are alike: if most show the
/// centre, those that show nothing were seen from there as well.
/// @param signs of each scan
void confirmViewpoints(std::vector<PreparedScan>& scans, const std::vector<ViewpointSign>& signs);

/// Scans whose viewpoint must be wrong, since their free space contradicts what many features agree on. A viewpoint that
/// a file gives for a scan of wide view, or that its points show, is never held wrong: rooms that look alike are the
/// likelier reason.
/// @return per scan
std::vector<char> wrongViewpoints(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
                                  double max_violation);
} // namespace fresco::registration
