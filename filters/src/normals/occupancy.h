// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/types.h>
#include <vector>
namespace fresco::filters {
/// Cells of a grid that hold points.
class Occupancy {
public:
  /// @param points  3xN, finite, N >= 1
  /// @param spacing between neighbouring points; cells are about twice as large
  /// @param endless whether a way that leaves the points' bounding box is the longest, else of length 0
  Occupancy(const Points& points, float spacing, bool endless);

  /// Length of the way from a point of a surface to the next cell with points, without the first steps, which are the
  /// surface itself.
  /// @param direction of any length but 0
  /// @param most      lengths of `direction` after which the way ends, free to there; 0 = at the bounding box
  float freeWay(const Eigen::Vector3f& from, const Eigen::Vector3f& direction, float most = 0) const;

private:
  Eigen::Vector3f low_;
  Eigen::Array3i size_;
  float cell_;
  bool endless_;
  std::vector<bool> occupied_;
};
} // namespace fresco::filters
