// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/image.h>
#include <fresco/core/point_set.h>
#include <string>
#include <vector>
namespace fresco::simulation {
/// In another size, by nearest pixels.
Image enlarged(const Image& image, int width, int height);
Image16 enlarged(const Image16& image, int width, int height);

/// Bytes of a LAS file, version 1.2, point format 2: coordinates to a tenth of a millimetre, intensities, colours.
/// Non-finite points are left out.
/// @param times GPS time of each point, which makes it format 3; or none
std::string lasFile(const PointSet& points, const std::vector<double>& times = {});

/// 3xN: normals of the planes through the nearest points, towards `points.viewpoints` (one).
Points nearbyNormals(const PointSet& points);
} // namespace fresco::simulation
