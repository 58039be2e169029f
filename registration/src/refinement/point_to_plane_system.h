// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/prepared_scan.h"
#include <fresco/core/rigid_motion.h>
namespace fresco::registration {
constexpr float match_angle = 1.0f; ///< radians between the normals of a match: wide, as start poses may be turned

/// Counterpart of a sample.
struct Match {
  Index target = -1;    ///< point of the target, -1 = none
  float residual = 0.f; ///< r = n . (T x - y), length
};

/// The samples of one scan matched to another.
struct DirectedPair {
  Index source = 0, target = 0; ///< scans
  int level = 0;                ///< of both
  std::vector<Match> matches;   ///< one per sample of the source
  double cutoff = 0.0;          ///< residual from which the weight is zero, length
  double weight = 1.0;          ///< of all matches, 0..1
};

/// A directed pair at one resolution and at its present poses.
struct LevelPair {
  const ScanLevel &source, &target;
  Eigen::Isometry3f T_target_source;
  bool oriented; ///< whether the signs of the normals of both mean something
};

/// Samples begin .. end - 1 of the source.
struct SampleRange {
  Index begin, end;
};

/// Normal equations H x = -b of one directed pair in the working frame of its target, with the rows J = [x cross n; n]
/// of its residuals (Chen & Medioni 1992): H = sum w J J^T, b = sum w r J.
struct PairSystem {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double squares = 0.0; ///< sum of r^2 of the matches that the robust weight keeps
  Index count = 0;      ///< of these matches

  PairSystem& operator+=(const PairSystem& other);
};

/// Jacobians of a pair's residuals with respect to (rotation about the scan's centre, translation) in world axes are
/// M_source J and M_target J with J of PairSystem.
struct PairJacobian {
  Matrix6d M_source = Matrix6d::Zero(), M_target = Matrix6d::Zero();

  PairJacobian(const Eigen::Isometry3d& T_world_target, const Eigen::Isometry3d& T_target_source);
};

/// Sets the matches of a range: nearest points below `distance` whose normals agree, on a smooth surface.
void findMatches(const LevelPair& level, const SampleRange& range, float distance, DirectedPair& pair);

/// Sets the cutoff of Tukey's biweight by the median of the residuals; zero with too few matches.
/// @param voxel of the level, length
void findCutoff(float voxel, DirectedPair& pair);

/// Adds match k of the pair to the system, unless its weight is zero. Weight w: Tukey's biweight (1 - (r / cutoff)^2)^2, times what rough surfaces are
/// worth and the pair's weight.
void addMatch(const LevelPair& level, const DirectedPair& pair, Index k, PairSystem& system);

/// Sum over the matches of a range.
PairSystem accumulate(const LevelPair& level, const SampleRange& range, const DirectedPair& pair);
} // namespace fresco::registration
