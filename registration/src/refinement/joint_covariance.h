// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/point_to_plane_system.h"
#include <array>
namespace fresco::registration {
/// What the matches of one directed pair within one cell of the world say.
struct CellSystem {
  std::array<std::int32_t, 3> cell = {};
  Index pair = 0;
  PairSystem system;
};
using CellSystems = std::vector<CellSystem, Eigen::aligned_allocator<CellSystem>>;

/// Two scans of a directed pair, and how its residuals depend on them.
struct PairLink {
  Index source = 0, target = 0;
  PairJacobian jacobian;
};

/// Normal equations of a joint refinement at its end, cell by cell.
struct JointSystem {
  const IsometryVector& poses;       ///< world from working frame
  const std::vector<Index>& holders; ///< per scan, the scan whose pose defines the frame of its group
  std::vector<PairLink, Eigen::aligned_allocator<PairLink>> links; ///< per pair
  CellSystems cells;                                               ///< ordered by (cell, pair)
  bool fit = true; ///< whether groups as a whole may be anywhere: covariances count relative to their best fit as well
  double size = 1.0; ///< length that makes rotations comparable with translations
  int threads = 0;
};

using Covariances = std::vector<Matrix6d, Eigen::aligned_allocator<Matrix6d>>;

/// Two parts of a group that move against each other most easily where one pair of scans is pulled apart.
struct LooseCut {
  std::vector<Index> body, rest;           ///< scans, rising
  std::vector<Index> linked;               ///< scans of either that matches across the cut join, rising
  Index about = 0;                         ///< scan of the body
  Matrix6d information = Matrix6d::Zero(); ///< of matches across the cut: rotation (about that scan's centre) first
};
using LooseCuts = std::vector<LooseCut, Eigen::aligned_allocator<LooseCut>>;

/// Inverse covariance of the pose of b relative to a by the matches of this pair alone, in both directions.
struct PairInformation {
  Index a = 0, b = 0;                      ///< a < b
  Matrix6d information = Matrix6d::Zero(); ///< rotation (about the centre of b, axes of the world) first
};
using PairInformations = std::vector<PairInformation, Eigen::aligned_allocator<PairInformation>>;

/// What the normal equations tell of poses: rotation (about the scan's centre, axes of the world) first.
struct PoseUncertainty {
  /// Of each scan. Cluster-robust, in the form of a jackknife over cells (Bell & McCaffrey 2002): errors of one cell may
  /// depend on each other in any way, among all pairs that see it. What counts is how much the solution changes without
  /// the cell. Relative to the holder of the group, or to the best fit of the whole group where that is larger; zero for
  /// the holders of groups that are not fitted.
  Covariances covariances;
  /// Of each scan; weights of one match sum up. What moves is the scan together with those that go along where it is held
  /// least, all others held: two scans of a room that hold each other may slide along a corridor as one. Zero for the
  /// holder of a group.
  Covariances information;
  /// One for each pair of scans that has matches, distinct. Whichever scan holds the frame: seen from it, a loose part
  /// elsewhere may be hidden by a looser one.
  LooseCuts cuts;
  PairInformations
      informations; ///< of each pair that has matches, ordered; the errors of one cell may depend on each other
};

/// @param cuts whether loose cuts are wanted
PoseUncertainty findUncertainty(const JointSystem& joint, bool cuts);
} // namespace fresco::registration
