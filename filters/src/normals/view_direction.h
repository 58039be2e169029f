// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/types.h>
namespace fresco::filters {
/// From a point to where it was seen from, not normalised; zero where that is unknown.
/// @param viewpoints 3xN by column, 3x1 one for all, or 3x0 unknown
/// @param point that of the column, which a caller has at hand
inline Eigen::Vector3f viewDirection(const Points& viewpoints, Index column, const Eigen::Vector3f& point)
{
  if (viewpoints.cols() == 0)
    return Eigen::Vector3f::Zero();
  const Eigen::Vector3f view = viewpoints.col(viewpoints.cols() == 1 ? 0 : column) - point;
  return view.allFinite() ? view : Eigen::Vector3f::Zero();
}
} // namespace fresco::filters
