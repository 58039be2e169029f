// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <vector>
namespace fresco::registration {
struct OrientedPoints {
  Points points;  ///< 3xK
  Points normals; ///< 3xK unit
};

/// Two points, one of each of two sets, that may be the same.
struct Correspondence {
  Index a = 0, b = 0;
};

/// A relative pose that several correspondences agree on.
struct PoseHypothesis {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  Index votes = 0;    ///< correspondences that agree
  double score = 0.0; ///< of later checks; larger is better
};
using PoseHypotheses = std::vector<PoseHypothesis, Eigen::aligned_allocator<PoseHypothesis>>;

struct Sc2PcrOptions {
  float tolerance = 0.f;  ///< of distances between corresponding points (d_thr of the paper), length
  float size = 1.f;       ///< of the scans, length; makes rotations comparable with translations
  std::size_t most = 60;  ///< hypotheses
  bool exclusive = false; ///< whether correspondences that agree with one pose start no other: finds the less popular
};

/// Poses from correspondences with many outliers by second-order spatial compatibility: Chen, Sun, Yang, Tao 2022,
/// "SC2-PCR: A Second Order Spatial Compatibility for Efficient and Robust Point Cloud Registration" (CVPR). No random
/// numbers are drawn. Most votes first; no two are nearly equal. Unlike the paper:
/// - compatibility asks for angles of normals too, and for points that are not too near to each other;
/// - a seed is a pair of correspondences, the partner being the one of the largest second-order compatibility. The paper
///   takes single correspondences by the leading eigenvector of the first-order matrix;
/// - the consensus set is all that is compatible with both of the pair, in one stage without a limit k;
/// - each set gives a pose by least squares without spectral weights, refitted to all correspondences that agree;
/// - many distinct hypotheses are returned, to be verified on all points, where the paper keeps that of most inliers.
FRESCO_EXPORT PoseHypotheses runSc2Pcr(const OrientedPoints& a, const OrientedPoints& b,
                                       const std::vector<Correspondence>& matches, const Sc2PcrOptions& options);

/// Distance that a point at `size` moves between two poses, about; length.
double poseDistance(const Eigen::Isometry3d& first, const Eigen::Isometry3d& second, double size);
} // namespace fresco::registration
