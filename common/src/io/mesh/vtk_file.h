// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_table.h>
#include <string>
#include <string_view>
namespace fresco::io {
/// Legacy VTK polydata, ASCII or binary; point data arrays become columns.
/// @throws std::runtime_error if malformed, truncated, of another kind of dataset or without points
MeshTable parseVtk(std::string_view content);

/// Legacy VTK polydata, binary. Normals become NORMALS, colours COLOR_SCALARS, the rest arrays of a FIELD.
void writeVtk(const std::string& path, PointTable vertices, const Faces& faces);

/// XML PolyData (.vtp), raw and not compressed; the same arrays.
void writeVtp(const std::string& path, PointTable vertices, const Faces& faces);
} // namespace fresco::io
