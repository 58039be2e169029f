// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/simulation/scene/places.h>
namespace fresco::simulation {
/// Views from many places that together show every part of the surface several times, from near and not too obliquely.
/// Images are named view_NNN.jpg.
/// @throws std::invalid_argument if `count` is not positive
CameraSet chooseViews(const PlanningInput& input, const CameraModel& camera, int count);
} // namespace fresco::simulation
