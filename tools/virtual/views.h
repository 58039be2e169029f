// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "virtual/places.h"
#include <fresco/common/camera.h>
namespace fresco {
/// Views from many places that together show every part of the surface several times, from near and not too obliquely.
/// Images are named view_NNN.jpg.
/// @throws std::invalid_argument if `count` is not positive
CameraSet chooseViews(const PlanningInput& input, const CameraModel& camera, int count);
} // namespace fresco
