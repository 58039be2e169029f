// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/scan_reader.h"
#include <fresco/io/file.h>
#include <string>
#include <string_view>
namespace fresco::io {
/// parse(content of `path`); every error is a std::runtime_error "PATH: reason".
template <typename Parse>
auto parseFile(const std::string& path, const Parse& parse) -> decltype(parse(std::string_view()))
{
  const std::string content = readFile(path);
  return namingFile(path, [&] { return parse(std::string_view(content)); });
}

/// Points of PCD, PLY, VTK, OBJ, XYZ by extension; colours packed as PCL has them.
/// @throws std::runtime_error "PATH: reason"
PointTable readTable(const std::string& path);

/// PCD (binary), PLY (binary) or XYZ by extension.
/// @param compressed PCD as binary_compressed
void writeTable(const std::string& path, const PointTable& table, bool compressed = false);
} // namespace fresco::io
