// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/search/triangle_tree.h>
#include <fresco/surface/core/mesh_distance.h>
#include <vector>
namespace fresco::distance {
DistanceStatistics statistics(const std::vector<ClosestPoint>& closest);

/// The larger of both directions, for max, mean and RMS alike: B. Pitzer, Automatic Reconstruction of Textured 3D
/// Models (PhD thesis, Karlsruhe Institute of Technology), eq. 4.26.
TwoSidedDistance twoSided(const DistanceStatistics& to_reference, const DistanceStatistics& from_reference);

/// Whether the median angle exceeds 90 degrees.
/// @param angles degrees, 0..180
bool mostlyOpposite(std::vector<double> angles);

/// @param angles degrees, 0..180
/// @param turned takes 180 - angle
NormalDeviation deviation(std::vector<double> angles, bool turned);
} // namespace fresco::distance
