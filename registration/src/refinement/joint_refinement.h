// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/joint_covariance.h"
#include "scan/prepared_scan.h"
#include <fresco/core/progress.h>
#include <fresco/core/rigid_motion.h>
#include <utility>
namespace fresco::registration {
using ScanPointers = std::vector<const PreparedScan*>;

constexpr float reach_voxels =
    20.f; ///< how far start poses may be off unless said, finest voxels: a fifth of the range

constexpr float near_voxels = 4.f; ///< finest ones: poses are mostly nearer, and other walls and rooms are further off

struct JointOptions {
  float max_distance = 0.f;  ///< between corresponding points in the first iterations, length
  float min_overlap = 0.05f; ///< pairs below this share are left out, 0..1
  Index samples = 6000;      ///< points of a scan that look for a counterpart in each overlapping scan
  int first_level = 0;       ///< coarsest level used
  int last_level = -1;       ///< finest level used, -1 = the finest there is
  int max_iterations = 40;   ///< per level
  float min_motion = 0.f;    ///< a level ends once no scan moves further, length; 0 = voxel / 500
  std::vector<std::pair<Index, Index>> excluded; ///< pairs not to use
  std::vector<Index> anchors; ///< rising; the first in a connected group keeps its pose, else the group's first scan
  std::vector<char> fixed;    ///< per scan, whether it does not move; pairs of two such are not used; empty = none
  bool covariances = false;   ///< whether covariances and informations are found
  bool cuts = false;          ///< whether loose cuts are found, too
  bool coarse_pairs = false;  ///< whether pairs that overlap only on `check_level` are used to the end
  int threads = 0;
};

/// Point-to-plane agreement of one pair at the end.
struct JointPair {
  Index source = 0, target = 0;
  Index matches = 0;   ///< correspondences that the robust weight kept
  double rms = 0.0;    ///< of their point-to-plane distances, length
  bool coarse = false; ///< whether only a coarser level than the last has surfaces in common
};

/// Uncertainties are empty unless asked for, but for the information; without covariances this is that of a scan, all others
/// held.
struct JointResult : PoseUncertainty {
  IsometryVector poses;         ///< world from working frame
  std::vector<JointPair> pairs; ///< both directions of each pair
  int iterations = 0;
  bool converged = false;
};

/// Moves all scans at once so that points of each lie on the surfaces of the others: point-to-plane distances of all
/// overlapping pairs in both directions (Chen & Medioni 1992, see PairSystem), Tukey weights, Levenberg-damped Gauss-Newton, coarse to
/// fine. With `coarse_pairs`, pairs that overlap only where points are sparse stay on `check_level`, and weigh as their
/// residuals say. Each connected group of scans keeps the pose of one of them.
JointResult refineJointly(const ScanPointers& scans, IsometryVector poses, const JointOptions& options,
                          const Progress& progress);

/// Of the levels of scans, coarse to fine.
struct LevelRange {
  int first, last;
};

/// Moves the second of two scans, which lies at `T_a_b` to about two voxels of the first level. One thread.
JointResult refinePair(const std::pair<const PreparedScan&, const PreparedScan&>& pair, const Eigen::Isometry3d& T_a_b,
                       const LevelRange& levels, Index samples);
} // namespace fresco::registration
