// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/joint_refinement.h"
#include <fresco/registration/core/scan_registration.h>
#include <optional>
#include <vector>
namespace fresco::registration {
/// Scans with a pose in one common frame, and what is known of their pairs.
struct Placement {
  std::vector<Index> members;    ///< indices of the scans
  IsometryVector poses;          ///< frame from working frame, one per member
  std::vector<Index> anchors;    ///< indices into members of the scans with a start pose
  JointResult joint;             ///< of the last refinement, indices into members
  std::vector<PairResult> pairs; ///< overlapping pairs, indices of scans
  bool look_alike = false;       ///< see ScanCluster
};

/// Refines all members at once, then leaves out the pairs that contradict each other's free space and refines again,
/// until every pair in use is consistent.
void refinePlacement(const std::vector<PreparedScan>& scans, const ScanRegistrationOptions& options,
                     Placement& placement, const Progress& progress);

/// What users get to know. Poses are those of the first placement: of its largest group, and of other scans that have a
/// start pose which no scan of that group contradicts.
/// @param placements each in a frame of its own, the most important first
ScanRegistrationResult describeRegistration(const std::vector<PreparedScan>& scans,
                                            const std::vector<Placement>& placements, const std::vector<Pose>& start,
                                            const ScanRegistrationOptions& options);
} // namespace fresco::registration
