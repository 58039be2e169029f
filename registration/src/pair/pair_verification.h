// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "overlap/pair_overlap.h"
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::registration {
/// A relative pose of two scans, refined and checked on their points.
struct VerifiedHypothesis {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  PairCheck check;
  Index votes = 0;              ///< features that agree
  double support = 0.0;         ///< overlap; less where few features agree and no free space bears witness, 0..1
  double score = 0.0;           ///< support, discounted by violations; larger is better
  bool has_free_motion = false; ///< whether the surfaces leave a motion free, as of a single wall
  bool has_alias = false; ///< one of several places that look alike to a scan: little overlap says nothing against it
};
using VerifiedHypotheses = std::vector<VerifiedHypothesis, Eigen::aligned_allocator<VerifiedHypothesis>>;

constexpr Index many_votes = 40; ///< agreeing features: hardly by chance

/// Two scans, and what makes their poses comparable.
struct PairGeometry {
  PairGeometry(const PreparedScan& a, const PreparedScan& b);
  const PreparedScan &a, &b;
  double size;      ///< of the scans, length
  double grain;     ///< poses that features or aliases lead to are the same if nearer to each other, length
  double tolerance; ///< refined poses are the same if nearer to each other, length
};

/// @return the first that is nearer to a pose than a distance (see poseDistance()), the end if there is none
VerifiedHypotheses::iterator findNear(const PairGeometry& pair, VerifiedHypotheses& hypotheses,
                                      const Eigen::Isometry3d& T_a_b, double distance);

struct VerificationOptions {
  float min_overlap = 0.1f;
  float max_violation = 0.04f;
  std::size_t checked = 20; ///< hypotheses that are left by the first check of few samples
  std::size_t refined = 8;  ///< hypotheses that are refined
};

/// Poses of a pair before they are refined.
struct FoundHypotheses {
  PoseHypotheses features; ///< by features: coarse
  PoseHypotheses planes;   ///< by planes: fine, but most of them wrong
  PoseHypotheses plans;    ///< by floor plans: coarse in place, few
};

/// Discount of an overlap by violations.
double alignmentScore(const PairCheck& check);

/// Whether free space speaks clearly against a pose with `violation` when another one has `other`.
bool clearlyWorse(double violation, double other);

/// Whether the best hypothesis cannot be believed by itself: another one explains the scans about as well, surfaces leave
/// a motion free, or the scans saw too little to rule out wrong ones and it rests on planes alone or may be mere chance.
/// @param hypotheses best first
bool isAmbiguous(const PairGeometry& pair, const VerifiedHypotheses& hypotheses);

/// Refined and checked.
VerifiedHypothesis verifyHypothesis(const PairGeometry& pair, const PoseHypothesis& hypothesis);

/// The hypotheses that pass the checks, refined, distinct, best first.
VerifiedHypotheses verifyHypotheses(const PairGeometry& pair, FoundHypotheses found,
                                    const VerificationOptions& options);
} // namespace fresco::registration
