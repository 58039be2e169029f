// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/export.h>
#include <limits>
#include <vector>
namespace fresco {
/// An upright prism: what a crop keeps.
struct CropRegion {
  /// Closed outlines, 2xK each, K >= 3, x y; without the first point again at the end. A point is inside where a ray
  /// crosses them an odd number of times, so that an outline in another one is a hole. None: everywhere.
  std::vector<Eigen::Matrix2Xd> outlines;
  double low = -std::numeric_limits<double>::infinity();            ///< z
  double high = std::numeric_limits<double>::infinity();            ///< above `low`
  Eigen::Isometry3d T_region_world = Eigen::Isometry3d::Identity(); ///< to where the prism is upright
};

/// @throws std::invalid_argument if an outline has less than 3 points, no area or a value that is not finite, if an edge
///         crosses or touches another one, or if `low` is not below `high`
FRESCO_EXPORT void validateCropRegion(const CropRegion& region);

/// Even-odd rule; what lies on the border is on one side of it.
FRESCO_EXPORT bool isInside(const CropRegion& region, const Eigen::Vector3d& world);
} // namespace fresco
