// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/point_table.h>
#include <fresco/core/require.h>
#include <limits>
namespace fresco::core {
namespace {
PointTable withoutColumns(const PointTable& table)
{
  PointTable empty;
  empty.width = table.width;
  empty.height = table.height;
  empty.sensor = table.sensor;
  return empty;
}

template <typename T>
T saturated(double value)
{
  using Limits = std::numeric_limits<T>;
  if constexpr (std::is_floating_point_v<T>)
    return value;
  else if (!(value > double(Limits::min()))) // NaN, too
    return std::isnan(value) ? 0 : Limits::min();
  else
    return value < double(Limits::max()) ? T(std::round(value)) : Limits::max();
}

bool isByte(const Column* column) { return column && column->type == Scalar::uint8 && column->count == 1; }
} // namespace

std::size_t scalarSize(Scalar type)
{
  return visitScalar(type, [](auto zero) { return sizeof(zero); });
}

const Column* PointTable::find(std::string_view name) const
{
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

void PointTable::addColumn(const std::string& name, Scalar type, std::size_t count)
{
  constexpr std::size_t most_columns = 10000; // far more than any file has, and few enough to look through all of them
  if (columns.size() == most_columns)
    throw std::runtime_error(concat("more than ", most_columns, " columns"));
  const std::string unique = find(name) ? concat(name, '_', columns.size() + 1) : name;
  if (find(unique))
    throw std::runtime_error(concat("two columns '", unique.substr(0, 40), "'"));
  columns.push_back({unique, type, count, stride});
  stride += columns.back().bytes();
}

void PointTable::allocate(Index row_count)
{
  rows = row_count;
  data.resize(row_count * stride);
}

void PointTable::own()
{
  if (view)
    data.assign(view, view + rows * stride);
  view = nullptr;
}

std::optional<std::array<Column, 3>> findTriple(const PointTable& table, NameTriple names)
{
  std::array<Column, 3> triple;
  for (int i = 0; i < 3; ++i) {
    const Column* column = table.find(names[i]);
    if (!column || column->count != 1)
      return std::nullopt;
    triple[i] = *column;
  }
  return triple;
}

const Column* packedColor(const PointTable& table)
{
  for (const char* name : {"rgb", "rgba"})
    if (const Column* column = table.find(name); column && column->count == 1 && scalarSize(column->type) == 4)
      return column;
  return nullptr;
}

Eigen::VectorXf columnValues(const PointTable& table, const Column& column, std::size_t component)
{
  Eigen::VectorXf values(table.rows);
  forEachValue(table, column, component, [&](Index row, auto value) { values[row] = value; });
  return values;
}

double valueAt(const PointTable& table, Index row, const Column& column)
{
  return visitScalar(column.type,
                     [at = table.cell(row, column)](auto zero) { return double(loadScalar<decltype(zero)>(at)); });
}

void storeValue(Scalar type, double value, void* at)
{
  visitScalar(type, [&](auto zero) {
    const auto stored = saturated<decltype(zero)>(value);
    std::memcpy(at, &stored, sizeof(stored));
  });
}

void copyRows(const PointTable& from, PointTable& to, Index begin)
{
  std::vector<std::pair<const Column*, const Column*>> shared;
  for (const Column& column : to.columns)
    if (const Column* source = from.find(column.name))
      shared.emplace_back(source, &column);
  for (Index row = 0; row < from.rows; ++row)
    for (const auto& [source, column] : shared)
      if (source->type == column->type)
        std::memcpy(to.cell(begin + row, *column), from.cell(row, *source), column->bytes());
      else
        storeValue(column->type, valueAt(from, row, *source), to.cell(begin + row, *column));
}

std::vector<bool> finiteRows(const PointTable& table)
{
  std::vector<bool> finite(table.rows, true);
  for (const char* name : xyz_names)
    if (const Column* column = table.find(name))
      eachValue(table, *column, [&](Index row, auto v) { finite[row] = finite[row] && std::isfinite(double(v)); });
  return finite;
}

void packColors(PointTable& table)
{
  const Column* alpha = table.find("alpha");
  const auto color = findTriple(table, color_names);
  if (!color || table.find("rgb") || table.find("rgba") ||
      !std::all_of(color->begin(), color->end(), [](const Column& c) { return isByte(&c); }))
    return;
  const bool has_alpha = isByte(alpha);
  PointTable packed = withoutColumns(table);
  for (const Column& column : table.columns)
    if (column.name == "red")
      packed.addColumn(has_alpha ? "rgba" : "rgb", has_alpha ? Scalar::uint32 : Scalar::float32);
    else if (column.name != "green" && column.name != "blue" && !(has_alpha && &column == alpha))
      packed.addColumn(column.name, column.type, column.count);
  packed.allocate(table.rows);
  copyRows(table, packed);
  const Column target = *packedColor(packed);
  for (Index row = 0; row < table.rows; ++row) {
    std::uint32_t value = has_alpha ? *table.cell(row, *alpha) : 0;
    for (const Column& channel : *color)
      value = value << 8 | *table.cell(row, channel);
    std::memcpy(packed.cell(row, target), &value, sizeof(value));
  }
  table = std::move(packed);
}

void unpackColors(PointTable& table)
{
  const Column* color = packedColor(table);
  if (!color)
    return;
  const bool has_alpha = color->name == "rgba";
  for (const char* name : color_names)
    if (table.find(name))
      return;
  if (has_alpha && table.find("alpha"))
    return;
  PointTable bytes = withoutColumns(table);
  for (const Column& column : table.columns) {
    if (&column != color) {
      bytes.addColumn(column.name, column.type, column.count);
      continue;
    }
    for (const char* name : color_names)
      bytes.addColumn(name, Scalar::uint8);
    if (has_alpha)
      bytes.addColumn("alpha", Scalar::uint8);
  }
  bytes.allocate(table.rows);
  copyRows(table, bytes);
  const Column first = *bytes.find("red");
  for (Index row = 0; row < table.rows; ++row) {
    const auto value = loadScalar<std::uint32_t>(table.cell(row, *color));
    std::uint8_t* at = bytes.cell(row, first);
    for (int channel = 0; channel < 3; ++channel)
      at[channel] = value >> (16 - 8 * channel);
    if (has_alpha)
      at[3] = value >> 24;
  }
  table = std::move(bytes);
}

double CoordinateBounds::extent() const { return std::max(0.0, (high - low).maxCoeff()); }

bool CoordinateBounds::exceedsFloat() const { return !(loss.maxCoeff() <= 1e-6 * extent()); }

Eigen::Vector3d CoordinateBounds::origin() const
{
  const double step = extent() > 0 ? std::exp2(std::floor(std::log2(extent()))) : 1.0;
  const Eigen::Array3d center = (0.5 * (low + high) / step).round() * step;
  return center.isFinite().select(center, 0.0).matrix();
}

CoordinateBounds coordinateBounds(const PointTable& table, const std::array<Column, 3>& xyz)
{
  CoordinateBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    double low = bounds.low[axis], high = bounds.high[axis], loss = 0;
    eachValue(table, xyz[axis], [&](Index, auto raw) {
      const double value = raw;
      if (!std::isfinite(value))
        return;
      low = std::min(low, value);
      high = std::max(high, value);
      loss = std::max(loss, std::abs(value - float(value)));
    });
    bounds.low[axis] = low;
    bounds.high[axis] = high;
    bounds.loss[axis] = loss;
  }
  return bounds;
}
} // namespace fresco::core
