// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mesh_formats.h"
#include "io/mesh/vtk_arrays.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <fresco/io/file.h>
namespace fresco::io {
namespace {
const VtkType& namesOf(Scalar type)
{
  return *std::find_if(std::begin(vtk_types), std::end(vtk_types), [&](const auto& n) { return n.type == type; });
}

/// Columns of equal type that are one array for VTK.
struct ColumnArray {
  std::string name;
  std::vector<Column> columns;

  Scalar type() const { return columns[0].type; }
  std::size_t components() const { return columns.size() * columns[0].count; }
};

/// Points, normals and colours (empty: there are none), everything else.
struct Arrays {
  ColumnArray points, normals, colors;
  std::vector<ColumnArray> rest;
};

Arrays arraysOf(const std::string& path, const PointTable& table)
{
  Arrays arrays;
  std::vector<std::string> used;
  const auto take = [&](const char* name, NameTriple names, ColumnArray& array) {
    if (const auto found = findTriple(table, names)) {
      array = {name, {found->begin(), found->end()}};
      used.insert(used.end(), std::begin(names), std::end(names));
    }
  };
  take("Points", xyz_names, arrays.points);
  take("Normals", normal_names, arrays.normals);
  take("rgb", color_names, arrays.colors);
  require(!arrays.points.columns.empty(), path, ": no coordinates x y z");
  for (const Column& column : table.columns)
    if (std::find(used.begin(), used.end(), column.name) == used.end())
      arrays.rest.push_back({column.name, {column}});
  return arrays;
}

/// The values of an array, row by row. @param swapped the high byte first, as legacy VTK stores them
std::string valuesOf(const PointTable& table, const ColumnArray& array, bool swapped)
{
  const std::size_t size = scalarSize(array.type());
  std::string bytes;
  bytes.reserve(table.rows * array.components() * size + 1);
  for (Index row = 0; row < table.rows; ++row)
    for (const Column& column : array.columns) {
      const std::size_t begin = bytes.size();
      bytes.append(reinterpret_cast<const char*>(table.cell(row, column)), column.bytes());
      for (std::size_t at = begin; swapped && at < bytes.size(); at += size)
        std::reverse(&bytes[at], &bytes[at] + size);
    }
  return bytes;
}

std::string swappedBytes(const PointTable& table, const ColumnArray& array)
{
  return valuesOf(table, array, true) + '\n';
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
  file.write(textOf("POLYGONS ", faces.cols(), ' ', 4 * faces.cols(), '\n'));
  std::string bytes;
  bytes.reserve(16 * static_cast<std::size_t>(faces.cols()));
  for (Index f = 0; f < faces.cols(); ++f)
    for (const std::int32_t value : {3, faces(0, f), faces(1, f), faces(2, f)})
      for (const int shift : {24, 16, 8, 0})
        bytes += char(value >> shift);
  file.write(bytes + '\n');
}

void writeAttributes(OutputFile& file, const PointTable& table, const Arrays& arrays)
{
  const bool has_colors = !arrays.colors.columns.empty(), has_normals = !arrays.normals.columns.empty();
  if (!has_normals && !has_colors && arrays.rest.empty())
    return;
  file.write(textOf("POINT_DATA ", table.rows, '\n'));
  if (has_colors)
    file.write("COLOR_SCALARS rgb 3\n" + swappedBytes(table, arrays.colors));
  if (has_normals)
    file.write("NORMALS Normals float\n" + swappedBytes(table, arrays.normals));
  if (!arrays.rest.empty())
    file.write(textOf("FIELD FieldData ", arrays.rest.size(), '\n'));
  for (const ColumnArray& array : arrays.rest)
    file.write(textOf(encodeName(array.name), ' ', array.components(), ' ', table.rows, ' ',
                      namesOf(array.type()).legacy, '\n') +
               swappedBytes(table, array));
}

std::string xmlText(const std::string& text)
{
  static constexpr std::pair<char, const char*> special[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string result;
  for (const char c : text) {
    const auto* const found =
        std::find_if(std::begin(special), std::end(special), [&](const auto& s) { return s.first == c; });
    result +=
        found != std::end(special) ? found->second : std::string(1, static_cast<unsigned char>(c) < ' ' ? '_' : c);
  }
  return result;
}

/// Arrays behind the XML of a file: each is its length in bytes, then its values.
struct AppendedData {
  std::vector<std::string> blocks;
  std::size_t size = 0;

  /// @return the element that stands for the array
  std::string add(const std::string& name, Scalar type, std::size_t components, std::string bytes)
  {
    const std::string element =
        textOf("<DataArray type=\"", namesOf(type).xml, "\" Name=\"", xmlText(name), "\" NumberOfComponents=\"",
               components, "\" format=\"appended\" offset=\"", size, "\"/>\n");
    size += sizeof(std::uint64_t) + bytes.size();
    blocks.push_back(std::move(bytes));
    return element;
  }
  std::string add(const PointTable& table, const ColumnArray& array)
  {
    return add(array.name, array.type(), array.components(), valuesOf(table, array, false));
  }
};

/// The elements of the triangles.
std::string addPolygons(const Faces& faces, AppendedData& data)
{
  std::string corners(reinterpret_cast<const char*>(faces.data()), faces.size() * sizeof(int)), ends;
  for (std::int64_t end = 3; end <= faces.size(); end += 3)
    ends.append(reinterpret_cast<const char*>(&end), sizeof(end));
  return data.add("connectivity", Scalar::int32, 1, std::move(corners)) +
         data.add("offsets", Scalar::int64, 1, std::move(ends));
}
} // namespace

void writeVtk(const std::string& path, PointTable table, const Faces& faces)
{
  unpackColors(table);
  const Arrays arrays = arraysOf(path, table);
  OutputFile file(path);
  file.write("# vtk DataFile Version 3.0\nfresco\nBINARY\nDATASET POLYDATA\n");
  file.write(textOf("POINTS ", table.rows, ' ', namesOf(arrays.points.type()).legacy, '\n'));
  file.write(swappedBytes(table, arrays.points));
  writePolygons(file, faces);
  writeAttributes(file, table, arrays);
  file.commit();
}

void writeVtp(const std::string& path, PointTable table, const Faces& faces)
{
  unpackColors(table);
  const Arrays arrays = arraysOf(path, table);
  AppendedData data;
  std::string point_data, roles;
  for (const auto& [array, role] : {std::pair(&arrays.normals, "Normals"), std::pair(&arrays.colors, "Scalars")})
    if (!array->columns.empty()) {
      point_data += data.add(table, *array);
      roles += textOf(' ', role, "=\"", array->name, '"');
    }
  for (const ColumnArray& array : arrays.rest)
    point_data += data.add(table, array);
  const std::string points = data.add(table, arrays.points), polygons = addPolygons(faces, data);
  OutputFile file(path);
  file.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\">\n<PolyData>\n");
  file.write(textOf("<Piece NumberOfPoints=\"", table.rows,
                    "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" ", "NumberOfPolys=\"",
                    faces.cols(), "\">\n<PointData", roles, ">\n", point_data, "</PointData>\n"));
  file.write("<Points>\n" + points + "</Points>\n<Polys>\n" + polygons + "</Polys>\n</Piece>\n</PolyData>\n");
  file.write("<AppendedData encoding=\"raw\">\n_");
  for (const std::string& block : data.blocks) {
    const std::uint64_t size = block.size();
    file.write(&size, sizeof(size));
    file.write(block);
  }
  file.write("\n</AppendedData>\n</VTKFile>\n");
  file.commit();
}
} // namespace fresco::io
