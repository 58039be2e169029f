// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/common/point_set.h>
namespace fresco {
/// From a point to where it was seen from, not normalised; zero where that is unknown.
inline Eigen::Vector3f viewDirection(const PointSet& set, Index column)
{
  if (set.viewpoints.cols() == 0)
    return Eigen::Vector3f::Zero();
  const Eigen::Vector3f view = set.viewpoints.col(set.viewpoints.cols() == 1 ? 0 : column) - set.points.col(column);
  return view.allFinite() ? view : Eigen::Vector3f::Zero();
}
} // namespace fresco
