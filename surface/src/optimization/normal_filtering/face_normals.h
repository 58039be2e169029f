// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/mesh_graph.h"
namespace fresco::optimization {
struct NormalFilterOptions {
  int rounds = 3;      ///< so many rings of faces take part: the width of the band along an edge that is rounded
  double sigma = 0.25; ///< chord of unit vectors (14 degrees) at which a neighbour has the greatest influence
  int threads = 0;
};

/// Filtered face normals, the first stage: n_f <- normalised sum over the faces g around f of A_g w(|n_g - n_f|) n_g,
/// with the area A and Tukey's biweight w. Smooths where normals differ little and sharpens where they differ much
/// (Sun et al. 2007 with another w; Zheng et al. 2011 without the spatial weight).
/// @param areas   3xF area vectors
/// @param given   3xF normals of the data on each face, as long as the area that they stand for; zero: there are none
/// @return 3xF unit; zero where a face has no area
Eigen::Matrix3Xf filterNormals(const MeshGraph& graph, const Eigen::Matrix3Xd& areas, const Eigen::Matrix3Xf& given,
                               const NormalFilterOptions& options);
} // namespace fresco::optimization
