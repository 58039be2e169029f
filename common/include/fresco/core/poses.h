// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/LU>
#include <optional>
namespace fresco {
/// 4x4, world from scan; nothing for a scan that could not be placed.
using Pose = std::optional<Eigen::Matrix4d>;

/// Poses farther away, in whatever unit, are refused where they are read: powers of them must fit into a float.
inline constexpr double farthest_position = 1e9;

/// Whether a position is finite and no farther away.
inline bool isInReach(const Eigen::Vector3d& position)
{
  return (position.array().abs() <= farthest_position).all(); // false for NaN
}

/// Whether a matrix is a rotation and no reflection.
/// @param tolerance by which entries of R R^T may differ from those of the identity
inline bool isRotation(const Eigen::Matrix3d& R, double tolerance)
{
  return R.allFinite() && (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= tolerance &&
         R.determinant() > 0;
}

/// Whether a matrix is a rotation and a translation within reach.
/// @param tolerance of isRotation(): how well whatever wrote the matrix kept to its digits
inline bool isRigid(const Eigen::Matrix4d& T, double tolerance)
{
  return isRotation(T.topLeftCorner<3, 3>(), tolerance) && isInReach(T.topRightCorner<3, 1>()) &&
         T.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-6);
}
} // namespace fresco
