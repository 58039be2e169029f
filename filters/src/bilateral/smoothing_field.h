// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/search/compressed_neighbor_lists.h>
#include <memory>
#include <vector>
namespace fresco::filters {
/// The points that have normals, in the order of a tree, with what smoothing needs of their places.
struct SmoothingField {
  std::unique_ptr<PointTree> tree;
  Points normals;                     ///< 3 x size of the tree, unit, by position
  Eigen::VectorXf areas;              ///< that points stand for, by position, any common factor
  Eigen::VectorXf radii;              ///< of the neighbourhoods, lengths: one by position, or one for all
  std::vector<CompressedLists> lists; ///< of the neighbourhoods of all positions, in order
};

/// @param normals 3xN, any length; points whose normal is not finite or zero are left out
SmoothingField makeSmoothingField(const Points& points, const Points& normals, const BilateralOptions& options);
} // namespace fresco::filters
