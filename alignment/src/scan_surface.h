// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_set.h>
#include <fresco/registration/core/surface_points.h>
#include <limits>
namespace fresco::alignment {
constexpr double most_cells = 2e7; ///< of a grid: bounds the memory

/// The surface of the scans as points of even density with normals (sign arbitrary), around their midst.
class ScanSurface {
public:
  ScanSurface(const PointSet& scans, int threads);

  const registration::SurfacePoints& level() const { return level_; }
  const Eigen::Vector3d& center() const { return center_; } ///< scans = center + surface
  double radius() const { return radius_; }                 ///< median distance of the points from their midst, length
  double grain() const { return level_.voxel; }             ///< distance of neighbouring points, length
  Eigen::Vector3f low() const { return low_; }
  Eigen::Vector3f high() const { return high_; }

  /// Whether a surface crosses the line from `eye` to `end`.
  bool isBlocked(const Eigen::Vector3f& eye, const Eigen::Vector3f& end) const;

private:
  void buildCells();
  Index cellAt(const Eigen::Vector3f& place) const; ///< -1 = outside
  registration::SurfacePoints level_;
  Eigen::Vector3d center_;
  double radius_ = 0;
  Eigen::Vector3f low_, high_;
  float cell_ = 0;
  Eigen::Array3i counts_;
  std::vector<int> point_of_cell_; ///< with a normal; -1 = none
};
} // namespace fresco::alignment
