// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_planes.h"
#include <optional>
namespace fresco::registration {
using UpDirections = std::vector<std::optional<Eigen::Vector3f>>;

/// Which way was up when each scan was taken, for scanners that did not stand upright: along one of the axes of its
/// planes, unit, in its working frame. The floor and the ceiling of one storey are equally far apart in all scans, walls
/// are not; and scanners see tables and cupboards from above.
/// @param planes of all scans
/// @return nothing for scans that show neither
UpDirections findUpDirections(const std::vector<PreparedScan>& scans, const std::vector<ScanPlanes>& planes);
} // namespace fresco::registration
