// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
namespace fresco::registration {
constexpr double alias_distance = 0.5; ///< of a scan's size: nearer places that look alike are one place
constexpr double next_door = 3.0;      ///< of a scan's size: a place further off is seen too badly to be told

/// Whether a motion of a scan leads to another place.
bool isElsewhere(const PreparedScan& scan, const Eigen::Isometry3d& T);

/// Motions that bring what is far from the scanner onto what is near it, by features.
PoseHypotheses matchFarToNear(const PreparedScan& scan, const ScanFeatures& features, const Sc2PcrOptions& sc2_pcr);

/// Aliases of which the scan saw little, such as an equal room through two doors: what is far fits to what is near, and
/// nothing contradicts it.
/// @param starts motions of the scan to begin from, a few of the coarsest voxels off
ScanAliases findPartialAliases(const PreparedScan& scan, PoseHypotheses starts);

/// A second place of which one scan saw little counts for all scans of the first: each scan receives the partial
/// aliases of those it overlaps largely. What one of them contradicts is dropped.
void sharePartialAliases(std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs);
} // namespace fresco::registration
