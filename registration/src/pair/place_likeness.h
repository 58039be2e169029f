// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
namespace fresco::registration {
/// What is looked at of a scan to guess which others saw the same place: few of its features.
struct PlaceSample {
  PlaceSample(const PreparedScan& scan, const ScanFeatures& features);
  const PreparedScan& scan;
  ScanFeatures features; ///< the most distinctive, and all planes
};

/// How well two scans fit at best, 0..1, in a hundredth of the time that alignPair() takes. The poses that most planes and
/// features agree on are tried as they are; the score of each is the overlap, discounted by the share of points in space
/// that the other scan saw through.
double placeLikeness(const PlaceSample& a, const PlaceSample& b, bool upright);
} // namespace fresco::registration
