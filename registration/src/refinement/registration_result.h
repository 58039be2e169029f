// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/placement.h"
namespace fresco::registration {
/// What users get to know. Poses are those of the first placement: of its largest group, and of other scans that have a
/// start pose which no scan of that group contradicts.
/// @param placements each in a frame of its own, the most important first
ScanRegistrationResult describeRegistration(const std::vector<PreparedScan>& scans,
                                            const std::vector<Placement>& placements, const std::vector<Pose>& start,
                                            const ScanRegistrationOptions& options);
} // namespace fresco::registration
