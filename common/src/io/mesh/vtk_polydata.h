// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/mesh/vtk_file.h"
namespace fresco::io {
/// XML PolyData (.vtp), raw and not compressed, with every column as an array.
void writeVtp(const std::string& path, const PointTable& vertices, const Faces& faces);

/// STL, ASCII or binary, by VTK; equal corners become one vertex. Nothing but vertices and faces.
VtkContent readStl(const std::string& path);

/// Binary STL: float coordinates, in which large ones lose digits, and no attributes.
void writeStl(const std::string& path, const PointTable& vertices, const Faces& faces);
} // namespace fresco::io
