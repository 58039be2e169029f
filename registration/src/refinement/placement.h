// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/joint_refinement.h"
#include <fresco/registration/core/scan_registration.h>
#include <optional>
namespace fresco::registration {
/// What a hint holds together.
struct HintedJoin {
  Index a = 0, b = 0;       ///< scans of either side
  std::string hint;         ///< RegistrationHint::source
  std::vector<Index> moved; ///< the side that was brought
};

/// Scans with a pose in one common frame, and what is known of their pairs.
struct Placement {
  std::vector<Index> members;                          ///< indices of the scans
  IsometryVector poses;                                ///< frame from working frame, one per member
  std::vector<Index> anchors;                          ///< indices into members of the scans with a start pose
  std::vector<char> fixed;                             ///< per member, whether it does not move; empty = none
  JointResult joint;                                   ///< of the last refinement, indices into members
  std::vector<PairResult> pairs;                       ///< overlapping pairs, indices of scans
  Index violating_points = 0;                          ///< of all pairs of members, see PairCheck
  Index holder = 0;                                    ///< index into members: keeps its pose where there is no anchor
  Refusal refusal;                                     ///< see ScanCluster
  std::vector<HintedJoin> hinted;                      ///< see ScanCluster
  std::vector<std::optional<FreeMotion>> free_motions; ///< per member; of unsteady parts, too
};

/// Standard deviation of the position of a member, length.
double positionDeviation(const JointResult& joint, Index member);

/// Whether a place that may be off by so much can be relied on.
bool holds(double deviation, const PreparedScan& scan);

/// Whether the others hold a member's place too loosely: a motion is free, or a scan that saw around may be off by more.
bool isLoose(const PreparedScan& scan, const Placement& placement, Index member);

/// Refines all members at once, then leaves out the pairs that contradict each other's free space and refines again,
/// until every pair in use is consistent. Pairs that share only what is sparse hold parts together where these are then held
/// well.
void refinePlacement(const std::vector<PreparedScan>& scans, const ScanRegistrationOptions& options,
                     Placement& placement, const Progress& progress);
} // namespace fresco::registration
