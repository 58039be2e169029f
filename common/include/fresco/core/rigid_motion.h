// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <vector>
namespace fresco {
using IsometryVector = std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Matrix of the cross product: skew(v) w = v x w.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v)
{
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// Rotation by a rotation vector, radians.
inline Eigen::Matrix3d rotation(const Eigen::Vector3d& w)
{
  const double angle = w.norm();
  return angle > 0.0 ? Eigen::AngleAxisd(angle, w / angle).toRotationMatrix()
                     : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

/// The nearest rotation of a product of rotations, whose rounding errors add up.
inline Eigen::Matrix3d normalized(const Eigen::Matrix3d& R)
{
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}
} // namespace fresco
