// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/point_table.h>
#include <string>
#include <string_view>
#include <vector>
namespace fresco::io {
/// What VTK calls a type, in its old files and in XML.
struct VtkType {
  Scalar type;
  const char *legacy, *xml;
};
inline constexpr VtkType vtk_types[] = {
    {Scalar::int8, "char", "Int8"},           {Scalar::uint8, "unsigned_char", "UInt8"},
    {Scalar::int16, "short", "Int16"},        {Scalar::uint16, "unsigned_short", "UInt16"},
    {Scalar::int32, "int", "Int32"},          {Scalar::uint32, "unsigned_int", "UInt32"},
    {Scalar::int64, "vtktypeint64", "Int64"}, {Scalar::uint64, "vtktypeuint64", "UInt64"},
    {Scalar::float32, "float", "Float32"},    {Scalar::float64, "double", "Float64"},
};

/// Values of one array of a VTK file, tuple by tuple, little-endian.
struct VtkArray {
  std::string name;
  Scalar type = Scalar::float32;
  std::size_t components = 1;
  std::vector<std::uint8_t> bytes;

  std::size_t tuples() const { return bytes.size() / (components * scalarSize(type)); }
  /// @throws std::runtime_error if they are no integers
  std::vector<std::int64_t> integers() const;
};

/// `points` as x y z, then a column for each array. "normals" become normals, three or four bytes a tuple (or an array
/// "colors") red green blue alpha; the second array of a name is left out. Every array has as many tuples as `points`.
PointTable tableOfArrays(const VtkArray& points, const std::vector<VtkArray>& arrays);

std::string lowerCase(std::string_view word);
} // namespace fresco::io
