// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/consensus.h"
#include "pair/pair_overlap.h"
#include <vector>
namespace fresco::registration {
/// A relative pose of two scans that passed the checks.
struct PairMode {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  PairCheck check;
  Index votes = 0;      ///< features that agree
  double support = 0.0; ///< overlap; less where few features agree and no free space bears witness, 0..1
  double score = 0.0;   ///< support, discounted by violations; larger is better
  bool twin = false;    ///< one of several places that look alike to a scan: little overlap says nothing against it
};
using PairModes = std::vector<PairMode, Eigen::aligned_allocator<PairMode>>;

constexpr Index many_votes = 40; ///< agreeing features: hardly by chance

/// All that is known of one pair of scans without a start pose.
struct PairAlignment {
  Index a = 0, b = 0;
  PairModes modes;        ///< best first, distinct; empty = the pair has no acceptable relative pose
  bool ambiguous = false; ///< several modes explain the scans about equally well
  PairModes refuted;      ///< none or one: pose that many features agree on, but which free space contradicts
};

struct PairAlignmentOptions {
  float min_overlap = 0.1f;
  float max_violation = 0.04f;
  bool upright = false;       ///< whether both scanners stood upright
  std::size_t matches = 1500; ///< correspondences of features
  std::size_t checked = 20;   ///< hypotheses that are checked for violations
  std::size_t refined = 8;    ///< hypotheses that are refined
};

/// Discount of an overlap by violations.
double alignmentScore(const PairCheck& check);

/// Whether free space speaks clearly against a pose with `violation` when another one has `other`.
bool clearlyWorse(double violation, double other);

/// Whether `other` explains two scans about as well as `best` does.
bool comparable(const PairMode& best, const PairMode& other);

/// The hypotheses that pass the checks, refined, distinct, best first.
PairModes acceptedModes(const PreparedScan& a, const PreparedScan& b, Hypotheses hypotheses,
                        const PairAlignmentOptions& options);

/// Global alignment of two scans from their features: hypotheses by consensus, the best by overlap and free space,
/// refined and checked again.
PairAlignment alignPair(const PreparedScan& a, const PreparedScan& b, const ScanFeatures& features_a,
                        const ScanFeatures& features_b, const PairAlignmentOptions& options);
} // namespace fresco::registration
