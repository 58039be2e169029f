// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "plan/section.h"
#include <Eigen/Core>
#include <vector>
namespace fresco::plan {
/// Samples on floors, ceilings and other level surfaces, evenly spread; frame of the plan.
struct LevelSamples {
  std::vector<Eigen::Vector3f> points;
  std::vector<int> facing;        ///< +1 up, -1 down, 0 not known
  double lowest = 0, highest = 0; ///< of the whole model
};
LevelSamples levelSamples(const MeshToCut& mesh);
LevelSamples levelSamples(const Points& cloud);

/// What is cut: heights in the frame of the plan, metres.
struct Storey {
  double height = 0, floor = 0, ceiling = 0;
  bool has_ceiling = false;
  double wall_low = 0, wall_high = 0; ///< where walls are looked for: nothing but walls is there
};

/// @param height NaN = 1.5 m above the lowest large floor
Storey findStorey(const LevelSamples& level, double height);

/// @param up any length above 0
Eigen::Matrix3d turnToZ(const Eigen::Vector3d& up);

/// Turn that makes the largest floor or ceiling level, found where it is tilted by less than about 5 degrees.
Eigen::Matrix3d levellingTurn(const LevelSamples& level);

/// Height of the largest of level surfaces, metres; NaN if there is none.
double mainHeight(std::vector<float> heights);

/// Samples on the surfaces of a storey that are not level, at most 2 cm apart along sections that are `section_pitch` apart.
constexpr double section_pitch = 0.05;
std::vector<Eigen::Vector3f> uprightSamples(const MeshToCut& mesh, const Storey& storey, int threads);
} // namespace fresco::plan
