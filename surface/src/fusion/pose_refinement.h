// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fusion/distance_grid.h"
namespace fresco::fusion {
/// Moves a frame onto the surface of a grid: Gauss-Newton on the signed distances of its pixels (Bylow, Sturm, Kerl,
/// Kahl & Cremers 2013), with Tukey's biweight. A weak prior keeps directions that the surface leaves free.
/// @param T_world_camera where to begin
/// @param given          pose that the prior holds to
/// @return world from camera; the frame's own pose where too few pixels lie near the surface
Eigen::Isometry3d alignToGrid(const DistanceGrid& grid, const DepthFrame& frame,
                              const Eigen::Isometry3d& T_world_camera, const Eigen::Isometry3d& given, int threads);
} // namespace fresco::fusion
