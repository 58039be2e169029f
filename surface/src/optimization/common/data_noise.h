// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/correspondences.h"
namespace fresco::optimization {
/// Standard deviation of data across the surface that they show, mean edge lengths, from the data alone: medians of how
/// far neighbours lie off quadrics that are fitted to them, near and farther around. Neighbours closer than usual count
/// once, since errors of one moment are alike: lines of a scanner, steps of its ranges, points given twice. 0 where the
/// offsets grow with the distance as shape does, or there are too few data.
double dataNoise(const DataPoints& data, int threads);
} // namespace fresco::optimization
