// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/remarks.h"
#include "io/mesh/ply.h"
#include "io/points/row_file.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cstring>
#include <fresco/io/file.h>
#include <fresco/io/ply_rows.h>
namespace fresco::io {
namespace {
std::string propertyLines(const PointTable& table)
{
  std::string lines;
  for (const Column& value : singleValues(table.columns))
    lines += textOf("property ", plyTypeName(value.type), ' ', plainName(value.name), '\n');
  return lines;
}

/// The element `camera` as PCL writes it.
std::pair<std::string, std::string> cameraElement(const PointTable& table, Index rows)
{
  std::string header = "element camera 1\n", row;
  const auto add = [&](const std::string& name, auto value) {
    header += textOf("property ",
                     sizeof(value) == 8                    ? "double"
                     : std::is_integral_v<decltype(value)> ? "int"
                                                           : "float",
                     ' ', name, '\n');
    row.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  const Eigen::Matrix3f axes = table.sensor->orientation.toRotationMatrix();
  for (int i = 0; i < 3; ++i)
    add(std::string("view_p") + "xyz"[i], static_cast<float>(table.sensor->position[i]));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      add(std::string(1, "xyz"[i]) + "_axis" + "xyz"[j], axes(i, j));
  for (const char* name : {"focal", "scalex", "scaley", "centerx", "centery"})
    add(name, 0.f);
  const bool organised = table.height > 0;
  add("viewportx", static_cast<int>(organised ? table.width : rows));
  add("viewporty", static_cast<int>(organised ? table.height : 1));
  add("k1", 0.f);
  add("k2", 0.f);
  return {header, row};
}

void writeFaces(OutputFile& file, const Faces& faces)
{
  constexpr Index at_most = Index{1} << 20;
  for (Index begin = 0; begin < faces.cols(); begin += at_most)
    file.write(plyFaceRows(faces, begin, std::min(begin + at_most, faces.cols())));
}

/// Colours as bytes, and only what PLY has types for.
void prepare(PointTable& table)
{
  unpackColors(table);
  PointTable known;
  known.sensor = table.sensor;
  known.width = table.width;
  known.height = table.height;
  bool any_long = false;
  for (const Column& column : table.columns) {
    const bool is_long = column.count == 1 && (column.type == Scalar::int64 || column.type == Scalar::uint64);
    if (is_long)
      remark("PLY has no 64-bit integers: double for the field " + column.name);
    known.addColumn(column.name, is_long ? Scalar::float64 : column.type, column.count);
    any_long = any_long || is_long;
  }
  if (!any_long)
    return;
  known.allocate(table.rows);
  copyRows(table, known);
  table = std::move(known);
}

/// Everything before the first vertex of `rows`, and what comes after faces.
std::pair<std::string, std::string> headerAndEnd(const PointTable& table, Index rows, Index faces)
{
  std::string header = textOf("ply\nformat binary_little_endian 1.0\nelement vertex ", rows, '\n');
  header += propertyLines(table);
  if (faces > 0)
    header += textOf("element face ", faces, "\nproperty list uchar int vertex_indices\n");
  std::string camera;
  if (table.sensor) {
    const auto [lines, row] = cameraElement(table, rows);
    header += lines;
    camera = row;
  }
  return {header + "end_header\n", camera};
}
} // namespace

std::string plyHeader(const PointTable& rows, Index vertices, Index faces)
{
  return headerAndEnd(rows, vertices, faces).first;
}

PointTable plyRows(PointTable vertices)
{
  prepare(vertices);
  return vertices;
}

std::string plyFaceRows(const Faces& faces, Index begin, Index end)
{
#pragma pack(push, 1)
  struct Row {
    std::uint8_t count;
    int corners[3];
  };
#pragma pack(pop)
  std::string rows((end - begin) * sizeof(Row), '\0');
  const auto store = [&](Index i) {
    const auto corners = faces.col(begin + i);
    const Row row{3, {corners[0], corners[1], corners[2]}};
    std::memcpy(&rows[i * sizeof(Row)], &row, sizeof(Row));
  };
  parallelFor(end - begin, 0, store, rows_per_task);
  return rows;
}

void writePly(const std::string& path, PointTable vertices, const Faces& faces)
{
  prepare(vertices);
  OutputFile file(path);
  const auto [header, end] = headerAndEnd(vertices, vertices.rows, faces.cols());
  file.write(header);
  file.write(vertices.data.data(), vertices.data.size());
  writeFaces(file, faces);
  file.write(end);
  file.commit();
}

void writePly(const std::string& path, Index rows, const std::function<PointTable(Index, Index)>& part,
              const Faces& faces)
{
  constexpr Index at_most = Index{1} << 19;
  const Index parts = std::max<Index>(1, (rows + at_most - 1) / at_most); // of about the same size
  PointTable table = part(0, rows / parts);
  prepare(table);
  OutputFile file(path);
  const auto [header, end] = headerAndEnd(table, rows, faces.cols());
  file.write(header);
  file.write(table.data.data(), table.data.size());
  for (Index i = 1; i < parts; ++i) {
    table = part(rows * i / parts, rows * (i + 1) / parts);
    prepare(table);
    file.write(table.data.data(), table.data.size());
  }
  writeFaces(file, faces);
  file.write(end);
  file.commit();
}
} // namespace fresco::io
