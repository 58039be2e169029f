// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <vector>
namespace fresco {
/// One point for each occupied cell of a grid through the lowest corner of the bounding box.
struct VoxelThinning {
  std::vector<Index> kept; ///< per cell the point nearest to its centroid, ascending; of equal ones that with the
                           ///< least coordinates, so that the order of the points does not matter
  Points centroids;        ///< 3xM mean of the points of the cell of each kept point
};

/// Non-finite points are left out.
/// @param cell side of the cells, length, > 0
/// @throws std::invalid_argument if `cell` is out of range or the points span more than 2^21 cells along an axis
FRESCO_EXPORT VoxelThinning thinByVoxel(const Points& points, float cell, int threads = 0);
} // namespace fresco
