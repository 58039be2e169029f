// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_table.h>
#include <string>
#include <string_view>
/// Readers and writers of meshes whose formats need no more than that; see ply.h and obj.h for the others.
namespace fresco::io {
/// STL, ASCII or binary: a file without zero bytes that begins with "solid" is ASCII. Equal corners become one vertex;
/// triangles with two equal corners are left out.
/// @throws std::runtime_error if malformed, truncated or without a triangle, or if a coordinate is not finite
TriangleMesh parseStl(std::string_view content);

/// Binary STL: coordinates as float, in which large ones lose digits, no attributes.
/// @throws std::runtime_error also if there is no face or too many of them
void writeStl(const std::string& path, const TriangleMesh& mesh);

/// Legacy VTK polydata, ASCII or binary; point data arrays become columns.
/// @throws std::runtime_error if malformed, truncated, of another kind of dataset or without points
MeshTable parseVtk(std::string_view content);

/// Legacy VTK polydata, binary. Normals become NORMALS, colours COLOR_SCALARS, the rest arrays of a FIELD.
void writeVtk(const std::string& path, PointTable vertices, const Faces& faces);

/// XML PolyData (.vtp), raw and not compressed; the same arrays.
void writeVtp(const std::string& path, PointTable vertices, const Faces& faces);
} // namespace fresco::io
