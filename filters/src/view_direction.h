// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/common/point_set.h>
namespace fresco {
/// From a point to where it was seen from, not normalised; zero where that is unknown.
/// @param point that of the column, which a caller has at hand
inline Eigen::Vector3f viewDirection(const PointSet& set, Index column, const Eigen::Vector3f& point)
{
  if (set.viewpoints.cols() == 0)
    return Eigen::Vector3f::Zero();
  const Eigen::Vector3f view = set.viewpoints.col(set.viewpoints.cols() == 1 ? 0 : column) - point;
  return view.allFinite() ? view : Eigen::Vector3f::Zero();
}
} // namespace fresco
