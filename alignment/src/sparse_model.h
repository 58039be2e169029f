// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/similarity.h>
#include <fresco/core/types.h>
#include <vector>
namespace fresco::alignment {
constexpr double vote_cell = 0.08; ///< of the votes, in the model's unit: half of its points lie within 12 cells
constexpr int settling = 5;        ///< steps after which a least squares solution stands
constexpr Index fewest_known = 20; ///< votes, normals or colours: fewer agree by chance

/// Sparse points of cameras, in a frame with the origin in their midst and half of them within distance 1.
struct SparseModel {
  Similarity T_model_cameras;
  Eigen::Matrix3Xd points;   ///< 3xN
  Eigen::Matrix3Xd seen;     ///< 3xN, where the pixels of their tracks see them
  Eigen::Matrix3Xd eyes;     ///< 3xN, where each is seen from: the camera of its track that is nearest to it
  Points colors;             ///< 3xN
  std::vector<Index> spread; ///< points no two of which lie in one half of a vote's cell: features of one thing
  Eigen::Matrix3Xd normals;  ///< of `spread`: unit, sign arbitrary; zero where the neighbours do not span a plane
  std::vector<Index> order;  ///< of `spread` with a normal: any first ones cover all directions of normals
};

/// @param points with tracks; those far beyond the others are left out
SparseModel makeSparseModel(const CameraSet& set, const SparsePoints& points, int threads);
} // namespace fresco::alignment
