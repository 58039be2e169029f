// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_features.h"
#include <Eigen/Geometry>
#include <vector>
namespace fresco::registration {
/// A relative pose that several correspondences agree on.
struct Hypothesis {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  Index votes = 0;    ///< correspondences that agree
  double score = 0.0; ///< of later checks; larger is better
};
using Hypotheses = std::vector<Hypothesis, Eigen::aligned_allocator<Hypothesis>>;

struct ConsensusOptions {
  float tolerance = 0.f;  ///< of distances between corresponding points, length
  float size = 1.f;       ///< of the scans, length; makes rotations comparable with translations
  std::size_t most = 60;  ///< hypotheses
  bool exclusive = false; ///< whether correspondences that agree with one pose start no other: finds the less popular
};

/// Poses supported by correspondences whose mutual distances and angles of normals agree in both scans. Sets of
/// agreeing correspondences grow from pairs that share the most agreeing others (Chen et al. 2022, "SC2-PCR: A Second
/// Order Spatial Compatibility for Efficient and Robust Point Cloud Registration"). Most votes first; no two are nearly
/// equal.
Hypotheses findConsensus(const ScanFeatures& a, const ScanFeatures& b, const std::vector<Correspondence>& matches,
                         const ConsensusOptions& options);

/// Distance that a point at `size` moves between two poses, about; length.
double poseDistance(const Eigen::Isometry3d& first, const Eigen::Isometry3d& second, double size);
} // namespace fresco::registration
