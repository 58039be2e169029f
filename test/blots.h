// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
namespace fresco::test {
/// Grey value of a place: blots of all sizes, so that features are found on every surface.
inline std::uint8_t blotted(const Eigen::Vector3d& at)
{
  double value = 0;
  for (const double size : {0.31, 0.13, 0.057}) {
    const Eigen::Vector3d cell = (at / size).array().floor();
    const Eigen::Vector3d within = at / size - cell - Eigen::Vector3d::Constant(0.5);
    const double chance = std::sin(cell.dot(Eigen::Vector3d(12.9898, 78.233, 37.719))) * 43758.5453;
    value += (chance - std::floor(chance) - 0.5) * std::exp(-8 * within.squaredNorm());
  }
  return static_cast<std::uint8_t>(std::clamp(128 + 150 * value, 0.0, 255.0));
}
} // namespace fresco::test
