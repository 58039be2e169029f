// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/pcd.h"
#include "io/points/text_numbers.h"
#include <fresco/io/file.h>
#include <liblzf/lzf.h>
#include <limits>
namespace fresco::io {
namespace {
std::string headerText(const PointTable& table, bool compressed)
{
  std::string fields, sizes, types, counts, viewpoint;
  for (const Column& column : table.columns) {
    fields += " " + singleWord(column.name);
    sizes += textOf(' ', scalarSize(column.type));
    types += textOf(' ', typeLetter(column.type));
    counts += textOf(' ', column.count);
  }
  if (table.sensor) {
    const auto& [position, q] = *table.sensor;
    viewpoint = "\nVIEWPOINT";
    for (const double value : position)
      viewpoint += " " + numberText(value);
    for (const float value : {q.w(), q.x(), q.y(), q.z()})
      viewpoint += " " + numberText(value);
  }
  const bool organised = table.height > 0;
  return textOf("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS", fields, "\nSIZE", sizes, "\nTYPE",
                types, "\nCOUNT", counts, "\nWIDTH ", organised ? table.width : table.rows, "\nHEIGHT ",
                organised ? table.height : 1, viewpoint, "\nPOINTS ", table.rows, "\nDATA ",
                compressed ? "binary_compressed" : "binary", '\n');
}

/// Two sizes and the data, column after column. Empty if they do not become smaller or are too large for the format.
std::string compressColumns(const PointTable& table)
{
  if (table.data.size() > std::numeric_limits<int>::max())
    return {};
  std::vector<char> columns;
  columns.reserve(table.data.size());
  for (const Column& column : table.columns)
    for (Index row = 0; row < table.rows; ++row) {
      const char* cell = reinterpret_cast<const char*>(table.cell(row, column));
      columns.insert(columns.end(), cell, cell + column.bytes());
    }
  const auto expanded = static_cast<std::uint32_t>(columns.size());
  std::string packed(8 + columns.size(), '\0');
  const std::uint32_t size = lzf_compress(columns.data(), expanded, packed.data() + 8, expanded);
  if (size == 0)
    return {};
  std::memcpy(packed.data(), &size, 4);
  std::memcpy(packed.data() + 4, &expanded, 4);
  packed.resize(8 + size);
  return packed;
}
} // namespace

void writePcd(const std::string& path, const PointTable& table, bool compressed)
{
  const std::string packed = compressed ? compressColumns(table) : std::string();
  OutputFile file(path);
  file.write(headerText(table, !packed.empty()));
  if (packed.empty())
    file.write(table.data.data(), table.data.size());
  else
    file.write(packed);
  file.commit();
}
} // namespace fresco::io
