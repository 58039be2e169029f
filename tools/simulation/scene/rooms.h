// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "simulation/scene/furniture.h"
namespace fresco::simulation {
/// The shell of rooms: free boxes in solid ground, and the solids that belong to the walls. No face is hidden.
struct Shell {
  std::vector<Box> boxes;
  void free(const Eigen::Vector3f& min, const Eigen::Vector3f& max, const BoxMaterials& sides)
  {
    boxes.push_back({min, max, sides, false});
  }
  void solid(const Eigen::Vector3f& min, const Eigen::Vector3f& max, int material)
  {
    boxes.push_back({min, max, allSides(material), true});
  }
};

/// A rectangle of floor.
struct Plan {
  Eigen::Vector2f min, max;
};

/// Skirting board along the four walls; `gaps` (openings) are cut out of it.
void addSkirting(Shell& shell, const Plan& room, const std::vector<Plan>& gaps, int material);

/// A window in the wall at y = `wall` that looks to +y (sign 1) or -y (sign -1): reveal, frame, panes, sill;
/// and a lamp for the daylight.
struct WindowSpec {
  float left = 0, right = 1, low = 0.95f, high = 2.3f; ///< metres, x and z
  float wall = 3, sign = 1;
  std::uint64_t seed = 1;
};
void addWindow(SceneBuilder& builder, const Palette& palette, Shell& shell, const WindowSpec& spec);

/// A closed door in the wall at x = `wall` towards -x (sign -1) or +x (sign 1): recess, casing; the handle is an object
/// of its own and is added by addHandle().
struct DoorSpec {
  float wall = -4, sign = -1, low = 0, high = 1; ///< low, high: range of y, metres
  std::uint64_t seed = 1;
};
void addDoor(SceneBuilder& builder, const Palette& palette, Shell& shell, const DoorSpec& spec);
void addHandle(SceneBuilder& builder, const Palette& palette, const DoorSpec& spec);

/// A lit panel let into the ceiling, and its lamp.
void addCeilingPanel(SceneBuilder& builder, const Palette& palette, Shell& shell, const Plan& plan, float ceiling);

Scene makeConferenceRoom(float max_edge);
Scene makeApartment(float max_edge);
} // namespace fresco::simulation
