// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
#include <fresco/core/point_table.h>
#include <fresco/core/textured_mesh.h>
#include <fresco/io/formats.h>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
namespace fresco {
struct ScanPath;
}
namespace fresco::io {
class ScanReader;
struct RowLayout;

/// A format of files: what it is called, how its names end, and who reads and writes it (nullptr: nobody).
struct Format {
  const char* name;
  std::vector<const char*> extensions; ///< in lower case, with the dot
  PointTable (*read_points)(const std::string& path) = nullptr;
  void (*write_points)(const std::string& path, const PointTable& points, bool compressed) = nullptr;
  TriangleMesh (*read_mesh)(const std::string& path) = nullptr;
  void (*write_mesh)(const std::string& path, const TriangleMesh& mesh) = nullptr;
  bool textured = false; ///< also read and written with texture, by texture_io.cpp, which links the image libraries

  /// For formats whose files may be plain rows: where they begin, from the begin of a file; see RowLayout.
  std::optional<RowLayout> (*row_layout)(std::string_view begin) = nullptr;

  /// For formats of several scans, or larger than memory; read_points then reads all scans as one cloud.
  std::unique_ptr<ScanReader> (*open_scans)(const ScanPath& path) = nullptr;

  bool reads(FileKind kind) const;
  bool writes(FileKind kind) const;
};

/// The one table of file formats, formats.cpp.
FRESCO_EXPORT const std::vector<Format>& formats();

/// The format by the extension of `path`. @throws std::runtime_error "PATH: not a mesh file: expected ..."
FRESCO_EXPORT const Format& formatToRead(const std::string& path, FileKind kind);
FRESCO_EXPORT const Format& formatToWrite(const std::string& path, FileKind kind);
} // namespace fresco::io
