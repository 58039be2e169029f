// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/scan_reader.h"
namespace fresco::io {
/// ASTM E2807, "E57": Cartesian or spherical points, packed whole numbers of any width or floats, colours, intensity,
/// normals (extension), row and column, and whatever else the prototype has. Page checksums are verified.
/// @throws std::runtime_error
std::unique_ptr<ScanReader> openE57(const std::string& path);

/// One scan, in the frame of its sensor where that is known.
void writeE57Points(const std::string& path, const PointTable& points, bool compressed);
} // namespace fresco::io
