// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/mesh_graph.h"
namespace fresco::optimization {
struct NormalFilterOptions {
  int rounds = 3;
  double sigma = 0.25; ///< normals that differ by more (chord of unit vectors) hardly influence each other
  int threads = 0;
};

/// Normals that the faces are to get: the field of the face normals, smoothed where it bends little and steepened where
/// it bends much (bilateral mesh denoising: Zheng, Fu, Au, Tai 2011).
/// @param areas   3xF area vectors
/// @param given   3xF normals of the data on each face, as long as the area that they stand for; zero where there are
/// none
/// @return 3xF unit; zero where a face has no area
Eigen::Matrix3Xf filterNormals(const MeshGraph& graph, const Eigen::Matrix3Xd& areas, const Eigen::Matrix3Xf& given,
                               const NormalFilterOptions& options);
} // namespace fresco::optimization
