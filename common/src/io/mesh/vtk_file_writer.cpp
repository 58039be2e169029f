// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/vtk_file.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
namespace fresco::io {
namespace {
const char* typeName(Scalar type)
{
  switch (type) {
  case Scalar::int8:
    return "char";
  case Scalar::uint8:
    return "unsigned_char";
  case Scalar::int16:
    return "short";
  case Scalar::uint16:
    return "unsigned_short";
  case Scalar::int32:
    return "int";
  case Scalar::uint32:
    return "unsigned_int";
  case Scalar::int64:
    return "vtktypeint64";
  case Scalar::uint64:
    return "vtktypeuint64";
  case Scalar::float32:
    return "float";
  case Scalar::float64:
    return "double";
  }
  throw std::logic_error("unknown scalar type");
}

/// Legacy VTK stores the high byte first.
void appendSwapped(std::string& bytes, const std::uint8_t* value, std::size_t size)
{
  bytes.append(std::make_reverse_iterator(value + size), std::make_reverse_iterator(value));
}

/// The values of some columns of equal type, row by row.
std::string columnBytes(const PointTable& table, const std::vector<Column>& columns)
{
  std::string bytes;
  bytes.reserve(table.data.size());
  for (Index row = 0; row < table.rows; ++row)
    for (const Column& column : columns)
      for (std::size_t k = 0; k < column.count; ++k)
        appendSwapped(bytes, table.cell(row, column) + k * scalarSize(column.type), scalarSize(column.type));
  return bytes + '\n';
}

std::string encodeName(const std::string& name)
{
  static constexpr char digits[] = "0123456789ABCDEF";
  std::string text;
  for (const char c : name)
    if (c <= ' ' || c == '%' || c == '"' || c > '~')
      text += {'%', digits[static_cast<unsigned char>(c) >> 4], digits[static_cast<unsigned char>(c) & 15]};
    else
      text += c;
  return text;
}

void writePolygons(OutputFile& file, const Faces& faces)
{
  file.write(concat("POLYGONS ", faces.cols(), ' ', 4 * faces.cols(), '\n'));
  std::string bytes;
  bytes.reserve(16 * static_cast<std::size_t>(faces.cols()));
  for (Index f = 0; f < faces.cols(); ++f)
    for (const std::int32_t value : {3, faces(0, f), faces(1, f), faces(2, f)})
      appendSwapped(bytes, reinterpret_cast<const std::uint8_t*>(&value), sizeof(value));
  file.write(bytes + '\n');
}

void writeAttributes(OutputFile& file, const PointTable& table)
{
  std::vector<Column> rest;
  const auto normals = findTriple(table, normal_names), colors = findTriple(table, color_names);
  const auto is_in = [](const auto& triple, const Column& column) {
    return triple &&
           std::any_of(triple->begin(), triple->end(), [&](const Column& c) { return c.name == column.name; });
  };
  const auto xyz = findTriple(table, xyz_names);
  for (const Column& column : table.columns)
    if (!is_in(xyz, column) && !is_in(normals, column) && !is_in(colors, column))
      rest.push_back(column);
  if (!normals && !colors && rest.empty())
    return;
  file.write(concat("POINT_DATA ", table.rows, '\n'));
  if (colors)
    file.write("COLOR_SCALARS rgb 3\n" + columnBytes(table, {colors->begin(), colors->end()}));
  if (normals)
    file.write("NORMALS Normals float\n" + columnBytes(table, {normals->begin(), normals->end()}));
  if (!rest.empty())
    file.write(concat("FIELD FieldData ", rest.size(), '\n'));
  for (const Column& column : rest)
    file.write(concat(encodeName(column.name), ' ', column.count, ' ', table.rows, ' ', typeName(column.type), '\n') +
               columnBytes(table, {column}));
}
} // namespace

void writeVtk(const std::string& path, const PointTable& vertices, const Faces& faces)
{
  PointTable table = vertices;
  unpackColors(table);
  const auto xyz = findTriple(table, xyz_names);
  require(xyz.has_value(), path, ": no coordinates x y z");
  OutputFile file(path);
  file.write("# vtk DataFile Version 3.0\nfresco\nBINARY\nDATASET POLYDATA\n");
  file.write(concat("POINTS ", table.rows, ' ', typeName((*xyz)[0].type), '\n'));
  file.write(columnBytes(table, {xyz->begin(), xyz->end()}));
  writePolygons(file, faces);
  writeAttributes(file, table);
  file.commit();
}
} // namespace fresco::io
