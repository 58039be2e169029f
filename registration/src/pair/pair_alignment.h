// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_verification.h"
#include "pair/plan_correlation.h"
#include "scan/scan_features.h"
#include <fresco/registration/core/scan_registration.h>
namespace fresco::registration {
/// All that is known of one pair of scans without a start pose.
struct PairAlignment {
  Index a = 0, b = 0;
  VerifiedHypotheses hypotheses; ///< best first, distinct; empty = the pair has no acceptable relative pose
  bool ambiguous = false;        ///< see isAmbiguous()
  VerifiedHypotheses rejected;   ///< none or one: pose that many features agree on, but which free space contradicts
};

struct PairAlignmentOptions {
  VerificationOptions verification;
  bool upright = false; ///< whether both scanners stood upright
};

PairAlignmentOptions pairOptions(const ScanRegistrationOptions& options);

struct DescribedScan {
  const PreparedScan& scan;
  const ScanFeatures& features;
  const PlanSpectrum* plan = nullptr; ///< null or empty: none
};

struct PlannedScan {
  const PreparedScan& scan;
  const PlanSpectrum& plan;
};

/// Leaves the poses between scanners that both stood upright.
void keepUpright(PoseHypotheses& poses);

/// Global alignment of two scans: hypotheses by features (SC2-PCR), planes and floor plans, the best by overlap and free
/// space, refined and checked again; and, for each alias of a scan, the hypothesis that lies at the other place.
PairAlignment alignPair(const DescribedScan& a, const DescribedScan& b, const PairAlignmentOptions& options);

/// The same of two scans that stood upright: hypotheses by their floor plans alone.
PairAlignment alignByPlans(const PlannedScan& a, const PlannedScan& b, const VerificationOptions& options);
} // namespace fresco::registration
