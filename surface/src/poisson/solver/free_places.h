// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples/samples.h"
#include <fresco/surface/core/free_space_map.h>
namespace fresco::poisson {
/// Where beams passed, asked in cells of the octree.
struct FreePlaces {
  const FreeSpaceMap* map = nullptr; ///< nullptr: nothing is known
  Cube cube;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(); ///< of the points

  /// @param position, tolerance in finest cells
  bool isFree(const Eigen::Vector3f& position, float tolerance) const
  {
    return map->isFree(origin + cube.corner + cube.cell() * position.cast<double>(), cube.cell() * tolerance);
  }
};
} // namespace fresco::poisson
