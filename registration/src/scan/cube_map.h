// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/types.h>
namespace fresco::registration {
/// Cell of a direction on a cube map with 6 * side * side cells.
/// @param across place on a face, -1..1, of a tangent in -1..1
template <typename Across>
Index cellOnCube(const Eigen::Vector3f& direction, int side, const Across& across)
{
  Index axis = 0;
  const float length = direction.cwiseAbs().maxCoeff(&axis);
  const Index face = axis * 2 + (direction[axis] < 0.f ? 1 : 0);
  const auto slot = [&](Index other) {
    return std::clamp(static_cast<int>((across(direction[other % 3] / length) + 1.f) * 0.5f * side), 0, side - 1);
  };
  return (face * side + slot(axis + 1)) * side + slot(axis + 2);
}

/// The same with cells that are about equally wide in angle.
inline Index cubeCell(const Eigen::Vector3f& direction, int side)
{
  return cellOnCube(direction, side, [](float t) {
    const float size = std::abs(t); // 4 / pi of the arc tangent, to 0.002
    return t + t * (1.f - size) * (0.3116f + 0.0844f * size);
  });
}
} // namespace fresco::registration
