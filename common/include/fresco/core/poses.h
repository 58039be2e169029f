// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
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
} // namespace fresco
