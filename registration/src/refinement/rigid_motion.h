// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/rigid_motion.h>
#include <vector>
namespace fresco::registration {
using IsometryVector = std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// The nearest rotation of a product of rotations, whose rounding errors add up.
inline Eigen::Matrix3d normalized(const Eigen::Matrix3d& R)
{
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}
} // namespace fresco::registration
