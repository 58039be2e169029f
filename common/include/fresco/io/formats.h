// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <string>
namespace fresco {
/// What a file holds for the one who asks: a mesh file also serves as a file of points.
enum class FileKind { points, mesh, textured_mesh };

/// Extensions that readPoints() and readCloud(), readMesh(), readTexturedMesh() know: ".ply, .obj or .vtk".
FRESCO_EXPORT std::string readableExtensions(FileKind kind);

/// Extensions that writePoints() and writeCloud(), writeMesh(), writeTexturedMesh() know.
FRESCO_EXPORT std::string writableExtensions(FileKind kind);

/// Whether the extension of `path` is one of readableExtensions(); the file need not exist.
FRESCO_EXPORT bool isReadable(const std::string& path, FileKind kind);

/// Whether the extension of `path` is one of writableExtensions().
FRESCO_EXPORT bool isWritable(const std::string& path, FileKind kind);
} // namespace fresco
