// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_table.h>
#include <fresco/io/file.h>
#include <new>
#include <string>
#include <string_view>
namespace fresco::io {
/// parse(content of `path`); every error is a std::runtime_error "PATH: reason".
template <typename Parse>
auto parseFile(const std::string& path, const Parse& parse) -> decltype(parse(std::string_view()))
{
  const std::string content = readFile(path);
  try {
    return parse(std::string_view(content));
  } catch (const std::bad_alloc&) {
    throw std::runtime_error(path + ": not enough memory");
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

/// Points of PCD, PLY, VTK, OBJ, XYZ by extension; colours packed as PCL has them.
/// @throws std::runtime_error "PATH: reason"
PointTable readTable(const std::string& path);

/// PCD (binary), PLY (binary) or XYZ by extension.
/// @param compressed PCD as binary_compressed
void writeTable(const std::string& path, const PointTable& table, bool compressed = false);
} // namespace fresco::io
