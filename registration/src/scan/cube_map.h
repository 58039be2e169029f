// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/types.h>
namespace fresco::registration {
/// Cell of a direction on a cube map with 6 * side * side cells that are about equally wide in angle.
inline Index cubeCell(const Eigen::Vector3f& direction, int side)
{
  Index axis = 0;
  const float length = direction.cwiseAbs().maxCoeff(&axis);
  const Index face = axis * 2 + (direction[axis] < 0.f ? 1 : 0);
  const auto slot = [&](Index other) {
    // 4 / pi of the arc tangent, to 0.002.
    const float t = direction[other % 3] / length, size = std::abs(t);
    const float across = t + t * (1.f - size) * (0.3116f + 0.0844f * size);
    return std::clamp(static_cast<int>((across + 1.f) * 0.5f * side), 0, side - 1);
  };
  return (face * side + slot(axis + 1)) * side + slot(axis + 2);
}
} // namespace fresco::registration
