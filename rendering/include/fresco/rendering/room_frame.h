// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
#include <optional>
#include <vector>
namespace fresco::rendering {
/// Where the floor and the walls of an indoor model are; coordinates relative to the mesh's origin.
struct RoomFrame {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();  ///< horizontal, along most of the walls
  Eigen::Vector3d across = Eigen::Vector3d::UnitY(); ///< up x along
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< (along, across, up) coordinates that 1 % of the area lies below
  Eigen::Vector3d high = Eigen::Vector3d::Zero(); ///< and 1 % above

  Eigen::Vector3d size() const { return high - low; }
  Eigen::Vector3d point(const Eigen::Vector3d& c) const { return c.x() * along + c.y() * across + c.z() * up; }
};

/// Unit directions, evenly over the part of the sphere between two values of z, each in -1..1 (Fibonacci lattice).
std::vector<Eigen::Vector3d> evenDirections(int count, double first_z, double last_z);

/// The upright direction: one that large parallel surfaces are orthogonal to, preferably along which the model extends
/// little (rooms are wider than high) and within 15 degrees of the z axis. It points to +z if it is near z, else away from the side
/// where more of the surface lies (furniture stands on the floor). A guess: where the upright direction is known,
/// use that.
/// @throws std::invalid_argument if the mesh has no face with an area
Eigen::Vector3d guessUp(const TriangleMesh& mesh);

/// @param up as known, any length above 0; nothing: guessUp()
/// @throws std::invalid_argument as guessUp(), and if `up` is zero or not finite
RoomFrame findRoomFrame(const TriangleMesh& mesh, const std::optional<Eigen::Vector3d>& up = {});
} // namespace fresco::rendering
