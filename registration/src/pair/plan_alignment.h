// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
#include "pair/plan_correlation.h"
namespace fresco::registration {
struct PlannedScan {
  const PreparedScan& scan;
  const PlanSpectrum& plan;
};

/// How well two scans fit at best, 0..1, in a fiftieth of the time that alignByPlans() takes: the poses that their floor
/// plans agree on are tried as they are, see roughLikeness().
double planLikeness(const PlannedScan& a, const PlannedScan& b);

/// Global alignment of two scans that stood upright: hypotheses by their floor plans, the best by overlap and free space,
/// refined and checked again.
PairAlignment alignByPlans(const PlannedScan& a, const PlannedScan& b, const VerificationOptions& options);

/// Motions that map a part of a scan onto another part of it, found by its floor plan; as findAliases().
ScanAliases findAliasesByPlan(const PlannedScan& scan);
} // namespace fresco::registration
