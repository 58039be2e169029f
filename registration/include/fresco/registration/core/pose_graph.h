// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/rigid_motion.h>
#include <fresco/core/types.h>
namespace fresco::registration {
/// A measured relative pose of two scans.
struct PoseEdge {
  Index a = 0, b = 0; ///< indices of poses
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  double weight = 1.0; ///< > 0
  /// Of the error's parts: rotation times PoseGraphOptions::size and translation, in the frame of b; positive semidefinite.
  Matrix6d information = Matrix6d::Identity();
};
using PoseEdges = std::vector<PoseEdge, Eigen::aligned_allocator<PoseEdge>>;

struct PoseGraphOptions {
  double size = 1.0;       ///< length that makes rotations comparable with translations, > 0
  double tolerance = 1.0;  ///< error of an edge at which its weight has fallen to a quarter, length, > 0
  int max_iterations = 50; ///< >= 1
  std::vector<char> fixed; ///< per pose, whether it stays; empty = the first stays
};

/// Poses that agree best with all edges: spreads the errors of loops over their edges. Levenberg-Marquardt over rigid
/// motions with the weights of Geman & McClure 1985, under which single wrong edges have little weight.
/// @param poses world from scan, near enough that most edges are within a few tolerances
FRESCO_EXPORT IsometryVector optimizePoseGraph(IsometryVector poses, const PoseEdges& edges,
                                               const PoseGraphOptions& options);
} // namespace fresco::registration
