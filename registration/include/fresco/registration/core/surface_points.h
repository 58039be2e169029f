// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/registration/core/neighbor_search.h>
#include <memory>
#include <vector>
namespace fresco::registration {
/// Points with their viewpoints, relative to a scan's centre.
struct RawScan {
  Points points, viewpoints; ///< 3xN
  Points colors;             ///< 3xN, or 3x0 where the scan has none
};

/// Finite points of a scan, seen from the center where no viewpoint is known.
FRESCO_EXPORT RawScan finitePoints(const PointSet& scan, const Eigen::Vector3d& center);

/// One point for each occupied cell of a grid: the mean; the viewpoint is that of its first point.
/// @param voxel edge of the cells, length
FRESCO_EXPORT RawScan thin(const RawScan& raw, float voxel);

/// A surface at one resolution: points of even density.
struct SurfacePoints {
  float voxel = 0.f;                      ///< edge of the thinning cells, length
  Points points;                          ///< 3xN, one per cell, the mean of its points
  std::shared_ptr<const PointTree> tree;  ///< over them, unless there is a search
  std::shared_ptr<NeighborSearch> search; ///< the caller's own, in place of the tree; may be null
  Points viewpoints;                      ///< 3xN
  Points colors;                          ///< 3xN, means over the cells, or 3x0
  Points normals;                         ///< 3xN unit, zero where the neighbours do not span a plane
  Eigen::Matrix<std::int32_t, 8, Eigen::Dynamic>
      around;                        ///< 8xN, nearest points, itself first, -1 = fewer; not of the finest
  Eigen::VectorXf surface_variation; ///< N, smallest eigenvalue / sum of eigenvalues of the neighbourhood, 0..1/3
};

constexpr Index fewest_points = 50; ///< thinned points of a scan: below, a pose has hardly any redundancy
/// Of a neighbourhood: beyond a third of the largest possible, its plane means little.
constexpr float variation_limit = 0.1f;

/// Sets normals and surface variations by planes through the nearest points; normals point to the points' viewpoints.
/// Surface variation: smallest eigenvalue of the covariance / sum of its eigenvalues (Pauly, Gross, Kobbelt 2002,
/// "Efficient Simplification of Point-Sampled Surfaces").
FRESCO_EXPORT void estimateNormals(SurfacePoints& surface, int threads);

/// Points with a normal in an order of which any prefix covers all directions of normals: a direction with m points
/// receives about sqrt(m) of the first places. After the normal-space sampling of Rusinkiewicz & Levoy 2001, "Efficient
/// Variants of the ICP Algorithm": rare directions pin down what common ones leave free.
FRESCO_EXPORT std::vector<Index> normalSpaceOrder(const SurfacePoints& surface);
} // namespace fresco::registration
