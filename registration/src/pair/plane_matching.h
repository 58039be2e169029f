// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_planes.h"
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::registration {
/// Poses under which the planes of two scans lie on each other: for each of the 24 ways in which their axes can agree,
/// shifts along each axis where the correlation of the histograms has a peak. After Weiss, Wetzler, von Puttkamer 1994,
/// "Keeping Track of Position and Orientation of Moving Indoor Systems by Correlation of Range-Finder Scans", there in
/// the plane. Rooms with hardly a feature have walls.
/// @return best first, at most `most`; none unless both scans have axes
PoseHypotheses matchPlanes(const ScanPlanes& a, const ScanPlanes& b, std::size_t most);
} // namespace fresco::registration
