// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// What was found, before it is described.
struct RegistrationState {
  const std::vector<PreparedScan>& scans;
  const std::vector<Pose>& start;
  const ScanRegistrationOptions& options;
  std::vector<Placement> placements; ///< each in a frame of its own, the most important first
  std::vector<PairAlignment> tried;  ///< pairs without start poses
  PlanPlaces plan_places;            ///< see ScanGraph
  std::vector<std::string> hints;    ///< what became of those that join nothing
};

/// What users get to know. Poses are those of the first placement: of its largest group, and of other scans that have a
/// start pose which no scan of that group contradicts.
ScanRegistrationResult describeRegistration(const RegistrationState& state);
} // namespace fresco::registration
