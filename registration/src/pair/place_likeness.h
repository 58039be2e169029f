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

/// How well two scans fit at a pose that is not refined, 0..1: the overlap, discounted by the share of points in space that
/// the other scan saw through, both of few samples.
/// @param least what is less may be 0
double roughLikeness(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b, double least);

/// How well two scans fit at best, 0..1, in a hundredth of the time that alignPair() takes. The poses that most planes and
/// features agree on are tried as they are, see roughLikeness().
double placeLikeness(const PlaceSample& a, const PlaceSample& b, bool upright);
} // namespace fresco::registration
