// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <string>
namespace fresco {
/// PCD, PLY, VTK, OBJ, XYZ (also .txt, .asc: x y z [r g b | nx ny nz | intensity]) by extension. Viewpoint of a PCD
/// header or fields vp_x vp_y vp_z become `viewpoints`. Non-finite points are kept.
/// @throws std::runtime_error "PATH: reason" if the file is missing, empty, truncated, malformed or without points
FRESCO_EXPORT PointSet readPoints(const std::string& path);

/// PCD (binary), PLY (binary) or XYZ by extension; whole or not at all. One common viewpoint goes into the PCD header,
/// one per point into vp_x vp_y vp_z.
FRESCO_EXPORT void writePoints(const std::string& path, const PointSet& set);
} // namespace fresco
