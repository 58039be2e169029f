// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/floor_plan.h"
#include <complex>
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::registration {
/// Poses of two plans: of 28 pairs of four floors 26 are right with 8, 27 with 16, 27 with 32.
constexpr std::size_t most_by_plans = 16;

/// Cells by the height of scanners, enough for `extent` (length) or as many along an edge as there may be.
PlanGrid makePlanGrid(float height, double extent, int most_side);

/// The grid for plans of scanners as high as most of `frames`, and scans as large as most of `scans`.
PlanGrid choosePlanGrid(const std::vector<std::optional<PlanFrame>>& frames, const std::vector<PreparedScan>& scans);

/// Discrete Fourier transforms of the layers of a floor plan, as it is and turned by 90 degrees.
class PlanSpectrum {
public:
  PlanSpectrum() = default;
  PlanSpectrum(const FloorPlan& plan, const PlanFrame& frame, const PlanGrid& grid);

  bool empty() const { return values_[0].empty(); }

  /// Poses under which two floor plans lie on each other, best first, distinct; at most `most`, none without plans.
  /// For each of the four ways in which the walls of two scans can agree and all shifts at once:
  /// sum over the layers of  O_a K O_b - w (F_a O_b + O_a F_b) + u F_a F_b,
  /// with the cells O that hold a point and F that were seen through, K blurs by a cell; as products of spectra. After
  /// Olson 2009, "Real-Time Correlative Scan Matching" (ICRA), there one scan at a time and without free space.
  friend PoseHypotheses matchPlans(const PlanSpectrum& a, const PlanSpectrum& b, std::size_t most);

private:
  using Spectrum = std::vector<std::complex<float>>; ///< columns 0..side/2 of each row, the others follow by symmetry
  std::array<Spectrum, 2> values_;                   ///< by turns of 90 degrees; per layer the occupied, the free cells
  PlanFrame frame_;
  PlanGrid grid_;
};

PoseHypotheses matchPlans(const PlanSpectrum& a, const PlanSpectrum& b, std::size_t most);
} // namespace fresco::registration
