// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fusion/distance_grid.h"
namespace fresco::fusion {
/// A point in each cell whose corners differ in sign: the mean of where its edges cross the surface (Gibson 1998,
/// "Constrained elastic surface nets", without the relaxation), with the gradient there as normal.
PointSet surfacePoints(const DistanceGrid& grid, int threads);
} // namespace fresco::fusion
