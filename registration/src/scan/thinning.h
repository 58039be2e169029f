// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <fresco/registration/core/surface_points.h>
namespace fresco::registration {
/// Resolutions: the coarsest cells, 8 times the finest, still show walls and furniture.
constexpr int level_count = 4;
constexpr double voxels_per_size = 100.0; ///< finest thinning: a room of 3 m radius in 3 cm cells

/// Where a scan was seen from, as far as its file tells.
struct WorkingCenter {
  Eigen::Vector3d place = Eigen::Vector3d::Zero(); ///< in the scan's frame
  bool given = false;                              ///< it is the first finite viewpoint
  bool assumed = false; ///< it is the frame's origin; neither: the middle of points that lie far from the origin
};
WorkingCenter workingCenter(const PointSet& scan);

/// Median distance of the finite points from the viewpoints (the scan's origin if unknown), length; 0 if there are
/// none.
double scanSize(const PointSet& scan);

/// How far the scan looks one way: length of the mean direction in which its points were seen, 0 all around .. 1.
double narrowness(const PointSet& scan);

/// The smallest voxel, `least` or more, that a scan of this density fills; length.
double fittingVoxel(const PointSet& scan, double least);

/// Edges of the cells of all levels; the same for all scans that are to be compared.
struct Thinning {
  /// Each level has cells of twice the edge.
  /// @param voxel finest, length
  explicit Thinning(double voxel) : Thinning(voxel, 0.0, 0.0) {}

  /// The same for scans of all directions. The coarsest cells of narrow, sparse scans stay as small as those of dense
  /// ones: too few points of what they see would be left.
  /// @param size       of the scans, length
  /// @param narrowness of the scans, 0..1
  Thinning(double voxel, double size, double narrowness);

  std::array<float, level_count> voxels; ///< fine to coarse
};
} // namespace fresco::registration
