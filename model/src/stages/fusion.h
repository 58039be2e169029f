// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/point_set.h>
#include <fresco/core/point_stream.h>
#include <unordered_map>
#include <vector>
namespace fresco::model {
/// Merges overlapping oriented point sets into one of even density: points of one cell whose normals point the same way
/// (towards the same side of a cube) become their mean, weighted by confidence. Memory follows the surface, not the
/// number of points added. The result depends on the order of add(), not on threads.
class PointFusion {
public:
  /// @param cell side of a cell, in the unit of the points, > 0
  explicit PointFusion(double cell);

  /// @param set in the common frame, with normals; missing confidences count as 1; other attributes are left out
  void add(const PointSet& set);

  /// In the order in which cells were first met. The confidence is the sum of those that fell into the cell.
  PointSet result() const;

private:
  struct Sum {
    Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    double weight = 0;
  };
  Sum& at(const Eigen::Vector3f& point, const Eigen::Vector3f& normal);

  double cell_;
  std::unordered_map<std::uint64_t, std::size_t> cells_;
  std::vector<Sum> sums_;
};

/// The points as they are while there are at most 16 a vertex; else averaged in cells of a third of `cell`, with the
/// attributes that the optimisation of a surface uses.
/// @param points   with normals
/// @param vertices of the surface that was reconstructed with cells of `cell`, length unit of the points, > 0
PointSet pointsForVertices(const PointStream& points, Index vertices, double cell);
} // namespace fresco::model
