// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/types.h>
namespace fresco {
/// Red-green-blue map of an error: red = 0, yellow, green = half of `largest`, cyan, blue = `largest` and more. Grey
/// where a distance is not finite.
/// @param distances N, >= 0, any unit
/// @param largest   the distance that is blue, same unit, >= 0; 0 makes every distance above 0 blue
/// @return 3xN
/// @throws std::invalid_argument if `largest` is negative or not finite
FRESCO_EXPORT Colors errorColors(const Eigen::VectorXf& distances, float largest);
} // namespace fresco
