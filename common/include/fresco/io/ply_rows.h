// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_table.h>
#include <string>
/// What a binary little-endian PLY file consists of, for those that write it piece by piece: header, vertices, faces.
namespace fresco::io {
/// @param rows columns of the vertices; any number of rows
FRESCO_EXPORT std::string plyHeader(const PointTable& rows, Index vertices, Index faces);

/// Vertices as their rows in the file.
FRESCO_EXPORT PointTable plyRows(PointTable vertices);

/// Rows of faces begin .. end - 1.
FRESCO_EXPORT std::string plyFaceRows(const Faces& faces, Index begin, Index end);
} // namespace fresco::io
