// SPDX-License-Identifier: BSD-3-Clause
// What columns mean: their names, the range of colours, the width of coordinates. Readers of all formats follow it.
#include <cctype>
#include <fresco/core/point_table.h>
#include <functional>
#include <limits>
#include <utility>
namespace fresco::core {
namespace {
struct Meaning {
  const char* name;
  std::initializer_list<const char*> others; ///< in lower case, blanks and the like as '_'
};

const Meaning meanings[] = {{"x", {"easting", "xcoord", "x_coord", "x_coordinate", "point_x", "points_0", "points:0"}},
                            {"y", {"northing", "ycoord", "y_coord", "y_coordinate", "point_y", "points_1", "points:1"}},
                            {"z", {"zcoord", "z_coord", "z_coordinate", "point_z", "points_2", "points:2"}},
                            {"normal_x", {"nx", "n_x", "normalx", "x_normal", "normals_0", "normals:0"}},
                            {"normal_y", {"ny", "n_y", "normaly", "y_normal", "normals_1", "normals:1"}},
                            {"normal_z", {"nz", "n_z", "normalz", "z_normal", "normals_2", "normals:2"}},
                            {"red", {"r", "rf", "diffuse_red", "color_r", "colour_r", "colorred", "color_red"}},
                            {"green", {"g", "gf", "diffuse_green", "color_g", "colour_g", "colorgreen", "color_green"}},
                            {"blue", {"b", "bf", "diffuse_blue", "color_b", "colour_b", "colorblue", "color_blue"}},
                            {"alpha", {"diffuse_alpha"}},
                            {"intensity", {"i", "intensities", "scalar_intensity"}},
                            {"confidence", {}},
                            {"vp_x", {}},
                            {"vp_y", {}},
                            {"vp_z", {}}};

bool isFloat(Scalar type) { return type == Scalar::float32 || type == Scalar::float64; }
bool isIn(const std::string& name, NameTriple names) { return std::count(names, names + 3, name) > 0; }
bool isPosition(const std::string& name) { return isIn(name, xyz_names) || isIn(name, viewpoint_names); }

/// What becomes of a column: values of another type.
struct Change {
  Scalar type;
  std::function<double(double)> value; ///< empty: the same
};

/// Columns for which change(column) gives something get other types or values.
template <typename ChangeOf>
void retype(PointTable& table, const ChangeOf& change)
{
  PointTable other;
  std::vector<std::optional<Change>> changes;
  for (const Column& column : table.columns) {
    changes.push_back(change(column));
    other.addColumn(column.name, changes.back() ? changes.back()->type : column.type, column.count);
  }
  const bool in_place = !table.view && other.stride <= table.stride; // no row is overwritten before it was read
  if (!in_place)
    other.data.resize(table.rows * other.stride);
  std::vector<std::uint8_t> row(other.stride);
  for (Index i = 0; i < table.rows; ++i) {
    for (std::size_t c = 0; c < changes.size(); ++c) {
      const Column &from = table.columns[c], &to = other.columns[c];
      if (!changes[c]) {
        std::memcpy(row.data() + to.offset, std::as_const(table).cell(i, from), to.bytes());
        continue;
      }
      const double value = valueAt(table, i, from);
      storeValue(to.type, changes[c]->value ? changes[c]->value(value) : value, row.data() + to.offset);
    }
    std::copy(row.begin(), row.end(), (in_place ? table : other).data.data() + i * other.stride);
  }
  if (!in_place)
    table.data = std::move(other.data);
  table.view = nullptr;
  table.columns = other.columns;
  table.stride = other.stride;
  table.data.resize(table.rows * table.stride);
}
} // namespace

std::string standardName(std::string_view name)
{
  std::string plain(name);
  for (char& c : plain)
    c = c == ' ' || c == '-' || c == '.' ? '_' : char(std::tolower(static_cast<unsigned char>(c)));
  for (const auto& [standard, others] : meanings)
    if (plain == standard || std::find(others.begin(), others.end(), plain) != others.end())
      return standard;
  return std::string(name);
}

double fullColor(Scalar type, double largest)
{
  constexpr double rounded = 1e-3; // sums of fractions
  if (isFloat(type) && largest <= 1 + rounded)
    return 1;
  if (scalarSize(type) == 1 || largest <= 255 + rounded)
    return 255;
  return largest <= std::numeric_limits<std::uint16_t>::max() ? std::numeric_limits<std::uint16_t>::max()
                                                              : std::numeric_limits<std::uint32_t>::max();
}

double largestValue(const PointTable& table, const std::array<Column, 3>& columns)
{
  double largest = 0;
  const auto look = [&](Index, auto value) {
    if (double(value) > largest && std::isfinite(double(value)))
      largest = double(value);
  };
  for (const Column& column : columns)
    eachValue(table, column, look);
  return largest;
}

double fullColor(const PointTable& table, const std::array<Column, 3>& rgb)
{
  const auto is_byte = [](const Column& column) { return scalarSize(column.type) == 1; };
  if (rgb[0].full > 0 || std::all_of(rgb.begin(), rgb.end(), is_byte))
    return rgb[0].full > 0 ? rgb[0].full : 255;
  return fullColor(rgb[0].type, largestValue(table, rgb));
}

void normalizeColors(PointTable& table)
{
  const auto rgb = findTriple(table, color_names);
  const auto is_byte = [](const Column& column) { return column.type == Scalar::uint8; };
  if (!rgb || std::all_of(rgb->begin(), rgb->end(), is_byte))
    return;
  const double full = fullColor(table, *rgb);
  retype(table, [&](const Column& column) -> std::optional<Change> {
    if (!isIn(column.name, color_names) || is_byte(column))
      return {};
    const bool is_signed_byte = column.type == Scalar::int8;
    return Change{Scalar::uint8,
                  [=](double v) { return is_signed_byte ? std::uint8_t(std::int8_t(v)) : colorByte(v, full); }};
  });
}

void narrowCoordinates(PointTable& table)
{
  const auto xyz = findTriple(table, xyz_names);
  const auto is_wide = [](const Column& column) { return column.type == Scalar::float64; };
  if (!xyz || !std::all_of(xyz->begin(), xyz->end(), is_wide) ||
      (table.rows > 0 && coordinateBounds(table, *xyz).exceedsFloat()))
    return;
  retype(table, [&](const Column& column) {
    return is_wide(column) && isPosition(column.name) ? std::optional(Change{Scalar::float32, {}}) : std::nullopt;
  });
}

void moveOrigin(PointTable& table, const Eigen::Vector3d& origin)
{
  retype(table, [&](const Column& column) -> std::optional<Change> {
    for (int axis = 0; axis < 3; ++axis)
      if (column.name == xyz_names[axis])
        return Change{Scalar::float64, [=](double value) { return value - origin[axis]; }};
    return {};
  });
}

PointTable tableOfRows(const std::vector<std::string>& names, const std::vector<double>& values)
{
  PointTable table;
  std::vector<std::size_t> sources;
  for (std::size_t c = 0; c < names.size(); ++c)
    if (!names[c].empty()) {
      const bool wide = isPosition(names[c]) || isIn(names[c], color_names);
      table.addColumn(names[c], wide ? Scalar::float64 : Scalar::float32);
      sources.push_back(c);
    }
  table.allocate(values.size() / names.size());
  for (std::size_t c = 0; c < sources.size(); ++c)
    for (Index row = 0; row < table.rows; ++row)
      storeValue(table.columns[c].type, values[row * names.size() + sources[c]], table.cell(row, table.columns[c]));
  normalizeColors(table);
  narrowCoordinates(table);
  return table;
}
} // namespace fresco::core
