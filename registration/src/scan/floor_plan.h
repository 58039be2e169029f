// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_planes.h"
#include <cstdint>
#include <optional>
namespace fresco::registration {
/// Where a floor plan is drawn: axes along the walls, z up, origin on the floor under the scanner.
struct PlanFrame {
  Eigen::Isometry3f T_plan_scan = Eigen::Isometry3f::Identity(); ///< from the scan's working frame
  float height = 0.f;                                            ///< of the scanner over the floor, length
};

/// @return nothing unless the scanner stood upright (15 degrees), saw a floor, and knows what it saw through
std::optional<PlanFrame> findPlanFrame(const PreparedScan& scan, const ScanPlanes& planes);

/// The same of a scanner that may have stood anyhow.
/// @param up one of the axes of the planes or its opposite, unit, in the scan's working frame
std::optional<PlanFrame> findPlanFrame(const PreparedScan& scan, const ScanPlanes& planes, const Eigen::Vector3f& up);

/// The frame of each scan's floor plan, where it has one.
using PlanFrames = std::vector<std::optional<PlanFrame>>;

/// Of all usable scans: if not all of them stood upright, of those that show which way was up (findUpDirections()).
PlanFrames findPlanFrames(const std::vector<PreparedScan>& scans, int threads);

/// Cells that the plans of all scans share.
struct PlanGrid {
  float cell = 0.f;   ///< edge, length
  int side = 0;       ///< cells per edge, a power of two
  float height = 0.f; ///< of the scanners over the floor, about; length
  /// Whether only cells with free neighbours count as free: rays pass through the cells of surfaces that they graze, which
  /// may send nothing back.
  bool inner_free = false;
};

constexpr int plan_layers = 3; ///< by height: legs and seats, tables and cupboards, above them

/// What a scan knows of the space over the floor, from above: 1 = yes. Cells are numbered by y, then x; the origin is
/// in cell (0, 0), what lies at negative coordinates follows cyclically.
struct FloorPlan {
  using Layer = std::vector<std::uint8_t>;
  std::array<Layer, plan_layers> occupied; ///< holds a point that is not of a ceiling
  std::array<Layer, plan_layers> free;     ///< was seen through, and neither the cell nor its neighbours hold a point
};

/// A scan and its place in a plan.
struct PlanScan {
  const PreparedScan& scan;
  Eigen::Isometry3f T_plan_scan; ///< from the scan's working frame
};

/// Moravec and Elfes 1985, "High Resolution Maps from Wide Angle Sonar", with rays of a laser and without probabilities.
FloorPlan drawFloorPlan(const std::vector<PlanScan>& scans, const PlanGrid& grid);
} // namespace fresco::registration
