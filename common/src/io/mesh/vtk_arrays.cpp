// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/vtk_arrays.h"
#include "io/files/expect.h"
#include <algorithm>
namespace fresco::io {
namespace {
std::vector<std::string> columnNames(const VtkArray& array)
{
  const std::string name = lowerCase(array.name);
  if (array.components == 3 && name == "normals")
    return {std::begin(normal_names), std::end(normal_names)};
  const bool is_color = array.type == Scalar::uint8 || name == "colors";
  if (array.components == 3 && is_color)
    return {std::begin(color_names), std::end(color_names)};
  if (array.components == 4 && is_color)
    return {"red", "green", "blue", "alpha"};
  return {array.name};
}
} // namespace

std::vector<std::int64_t> VtkArray::integers() const
{
  return visitScalar(type, [&](auto zero) {
    using T = decltype(zero);
    expect(!std::is_floating_point_v<T>, "VTK: cell indices are no integers");
    std::vector<std::int64_t> values(bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = loadScalar<T>(bytes.data() + i * sizeof(T));
    return values;
  });
}

std::string lowerCase(std::string_view word)
{
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

PointTable tableOfArrays(const VtkArray& points, const std::vector<VtkArray>& arrays)
{
  PointTable table;
  std::vector<std::pair<const VtkArray*, std::size_t>> sources; // array and its first column in the table
  const auto place = [&](const VtkArray& array, const std::vector<std::string>& names) {
    if (std::any_of(names.begin(), names.end(), [&](const std::string& name) { return table.find(name); }))
      return;
    sources.emplace_back(&array, table.columns.size());
    for (const std::string& name : names)
      table.addColumn(name, array.type, array.components / names.size());
  };
  place(points, {std::begin(xyz_names), std::end(xyz_names)});
  for (const VtkArray& array : arrays)
    place(array, columnNames(array));
  for (const auto& [array, column] : sources)
    expect(array->bytes.size() == points.tuples() * array->components * scalarSize(array->type), "VTK: '",
           array->name.substr(0, 40), "' has another number of tuples than the points");
  table.allocate(points.tuples());
  for (const auto& [array, column] : sources) {
    const std::size_t bytes = array->components * scalarSize(array->type);
    for (Index row = 0; row < table.rows; ++row)
      std::memcpy(table.cell(row, table.columns[column]), array->bytes.data() + row * bytes, bytes);
  }
  return table;
}
} // namespace fresco::io
