// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/columns.h"
#include "io/points/scan_reader.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <limits>
#include <stdexcept>
namespace fresco::io::e57 {
namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The smallest type that holds all values of a field.
Scalar typeFor(const Field& field)
{
  if (field.type == Field::Type::single_float)
    return Scalar::float32;
  if (field.type != Field::Type::integer)
    return Scalar::float64;
  constexpr struct {
    Scalar type;
    std::int64_t low, high;
  } ranges[] = {{Scalar::uint8, 0, 0xFF},        {Scalar::int8, -0x80, 0x7F},
                {Scalar::uint16, 0, 0xFFFF},     {Scalar::int16, -0x8000, 0x7FFF},
                {Scalar::uint32, 0, 0xFFFFFFFF}, {Scalar::int32, -0x80000000LL, 0x7FFFFFFF}};
  for (const auto& range : ranges)
    if (field.minimum >= range.low && field.maximum <= range.high)
      return range.type;
  return Scalar::int64;
}

/// The name of a column for a field that has no meaning here. Names that have one are not taken by it.
std::string columnName(const std::string& field)
{
  if (field == "rowIndex")
    return row_column;
  if (field == "columnIndex")
    return column_column;
  const auto in = [&](NameTriple names) { return std::count(names, names + 3, field) > 0; };
  const bool known = in(xyz_names) || in(normal_names) || in(viewpoint_names) || in(color_names) || field == "rgb" ||
                     field == "rgba" || field == "intensity" || field == row_column || field == column_column;
  return known ? "e57_" + field : field;
}

constexpr const char* color_fields[] = {"colorRed", "colorGreen", "colorBlue"};

/// What the file says of the range of a colour: the limits of the scan, else those of the field.
std::optional<Limits> saidLimits(const std::optional<Limits>& of_scan, const Field& field)
{
  if (of_scan || !field.isInteger())
    return of_scan;
  const auto value = [&](std::int64_t stored) {
    return field.type == Field::Type::integer ? double(stored) : double(stored) * field.scale + field.offset;
  };
  const Limits own{value(field.minimum), value(field.maximum)};
  return field.bits() < 64 && own.maximum > own.minimum ? std::optional(own) : std::nullopt;
}

/// Limits of fractions, bytes and 16 bits: writers mix them up, so that the values tell.
bool isUsual(const std::optional<Limits>& limits)
{
  return !limits ||
         (limits->minimum == 0 && (limits->maximum == 1 || limits->maximum == 255 || limits->maximum == 65535));
}

/// What stands for 0 and for 255.
Limits colorLimits(const std::optional<Limits>& said, const Field& field, double largest)
{
  if (said && !isUsual(said) && largest <= said->maximum)
    return *said;
  return {0, fullColor(field.type == Field::Type::integer ? Scalar::uint16 : Scalar::float64, largest)};
}

/// Whole numbers of 8 bits and more by their highest 8 bits, as elsewhere; others by their share of the range.
double byteWithin(double value, const Limits& limits)
{
  return colorByte(value - limits.minimum, limits.maximum - limits.minimum);
}

Eigen::Vector3d fromSpherical(double range, double azimuth, double elevation)
{
  return range * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                 std::sin(elevation));
}

template <typename T>
T converted(double value)
{
  if constexpr (std::is_integral_v<T>) // of a field whose limits fit: a damaged value must not be undefined behaviour
    return std::clamp<double>(value, std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
  else
    return value;
}
} // namespace

std::array<double, 3> largestColors(PagedFile& file, const Scan& scan)
{
  std::array<double, 3> largest{};
  std::array<std::size_t, 3> fields{};
  std::array<std::optional<Limits>, 3> limits;
  bool plain = true;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto field = scan.records.find(color_fields[channel]);
    if (!field)
      return largest;
    fields[channel] = *field;
    const Field& stored = scan.records.fields[*field];
    limits[channel] = saidLimits(scan.color[channel], stored);
    plain = plain && stored.type == Field::Type::integer && limits[channel] && stored.maximum <= 255 &&
            limits[channel]->maximum == 255;
    largest[channel] = limits[channel] ? limits[channel]->maximum : 0;
  }
  if (plain)
    return largest;
  largest.fill(0);
  constexpr std::uint64_t enough = 1 << 18; // records of a scan that says its limits
  VectorReader window(file, scan.records);
  std::uint64_t seen = 0;
  while (const std::size_t count = scan.color[0] && seen >= enough ? 0 : window.next(rows_per_window)) {
    seen += count;
    for (std::size_t channel = 0; channel < 3; ++channel)
      for (std::size_t i = 0; i < count; ++i)
        if (const double value = window.real(fields[channel], i); std::isfinite(value))
          largest[channel] = std::max(largest[channel], value);
  }
  const std::array<double, 3> own = largest;
  for (std::size_t a = 0; a < 3; ++a) // one range for channels of one kind
    for (std::size_t b = 0; b < 3; ++b)
      if (scan.records.fields[fields[a]].type == scan.records.fields[fields[b]].type &&
          limits[a].has_value() == limits[b].has_value() && (!limits[a] || limits[a]->maximum == limits[b]->maximum))
        largest[a] = std::max(largest[a], own[b]);
  return largest;
}

Columns::Columns(const Scan& scan, const std::array<double, 3>& largest_colors)
    : scan_(scan), taken_(scan.records.fields.size(), false)
{
  if (scan.records.find("cartesianX"))
    addCartesian();
  else
    addSpherical();
  addNormals();
  addColors(largest_colors);
  addIntensity();
  addOthers();
}

/// The field of that name; it is not looked at again.
std::optional<std::size_t> Columns::take(std::string_view name)
{
  const auto field = scan_.records.find(name);
  if (field && scan_.records.fields[*field].type == Field::Type::string)
    return std::nullopt;
  if (field)
    taken_[*field] = true;
  return field;
}

void Columns::add(const std::string& name, Scalar type, Values value)
{
  layout_.addColumn(name, type);
  plans_.push_back({layout_.columns.back(), std::move(value)});
}

void Columns::addCartesian()
{
  const std::vector<Field>& fields = scan_.records.fields;
  bool single = true;
  const char* const names[] = {"cartesianX", "cartesianY", "cartesianZ"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto field = take(names[axis]);
    if (!field)
      throw std::runtime_error(std::string("no field ") + names[axis]);
    position_[axis] = *field;
    single = single && fields[*field].type == Field::Type::single_float;
  }
  invalid_ = take("cartesianInvalidState");
  for (const char* name : xyz_names)
    layout_.addColumn(name, single ? Scalar::float32 : Scalar::float64);
}

void Columns::addSpherical()
{
  const char* const names[] = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto field = take(names[i]);
    if (!field)
      throw std::runtime_error("neither Cartesian nor spherical coordinates");
    position_[i] = *field;
  }
  spherical_ = true;
  invalid_ = take("sphericalInvalidState");
  for (const char* name : xyz_names)
    layout_.addColumn(name, Scalar::float64);
}

void Columns::addNormals()
{
  const char* const names[] = {"normalX", "normalY", "normalZ"};
  for (const char* name : names)
    if (const auto field = scan_.records.find(name); !field)
      return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const auto field = take(names[axis]))
      add(normal_names[axis], Scalar::float32,
          [f = *field](const VectorReader& window, std::size_t i) { return window.real(f, i); });
}

void Columns::addColors(const std::array<double, 3>& largest)
{
  for (const char* name : color_fields)
    if (!scan_.records.find(name))
      return;
  const auto invalid = scan_.records.find("isColorInvalid"); // stays a column: black may be a colour
  for (std::size_t channel = 0; channel < 3; ++channel)
    if (const auto field = take(color_fields[channel])) {
      const Field& stored = scan_.records.fields[*field];
      const Limits limits = colorLimits(saidLimits(scan_.color[channel], stored), stored, largest[channel]);
      add(color_names[channel], Scalar::uint8, [=, f = *field](const VectorReader& window, std::size_t i) {
        return invalid && window.real(*invalid, i) != 0 ? 0.0 : byteWithin(window.real(f, i), limits);
      });
    }
}

void Columns::addIntensity()
{
  const auto field = take("intensity");
  if (!field)
    return;
  const auto invalid = take("isIntensityInvalid");
  add("intensity", Scalar::float32, [=, f = *field](const VectorReader& window, std::size_t i) {
    return invalid && window.real(*invalid, i) != 0 ? nan : window.real(f, i);
  });
}

void Columns::addOthers()
{
  const std::vector<Field>& fields = scan_.records.fields;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f].type == Field::Type::string)
      remark(concat("field ", fields[f].name, " is left out: it holds texts"));
    if (taken_[f] || fields[f].type == Field::Type::string)
      continue;
    const std::string name = fields[f].own ? fields[f].name : columnName(fields[f].name);
    if (layout_.find(name))
      continue;
    const Scalar type = typeFor(fields[f]);
    if (type == Scalar::int64) {
      layout_.addColumn(name, type);
      integers_.emplace_back(layout_.columns.back(), f);
    } else
      add(name, type, [f](const VectorReader& window, std::size_t i) { return window.real(f, i); });
  }
}

void Columns::storePositions(const VectorReader& window, std::size_t count, PointTable& table, Index begin) const
{
  const Column& x = layout_.columns[0]; // y and z follow it
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d point(window.real(position_[0], i), window.real(position_[1], i), window.real(position_[2], i));
    if (invalid_ && window.real(*invalid_, i) != 0)
      point.setConstant(nan);
    else if (spherical_)
      point = fromSpherical(point[0], point[1], point[2]);
    std::uint8_t* cell = table.cell(begin + i, x);
    if (x.type == Scalar::float64) {
      std::memcpy(cell, point.data(), sizeof(point));
    } else {
      const Eigen::Vector3f single = point.cast<float>();
      std::memcpy(cell, single.data(), sizeof(single));
    }
  }
}

void Columns::store(const VectorReader& window, std::size_t count, PointTable& table, Index begin) const
{
  storePositions(window, count, table, begin);
  for (const Plan& plan : plans_)
    visitScalar(plan.column.type, [&](auto zero) {
      using T = decltype(zero);
      for (std::size_t i = 0; i < count; ++i) {
        const T value = converted<T>(plan.value(window, i));
        std::memcpy(table.cell(begin + i, plan.column), &value, sizeof(T));
      }
    });
  for (const auto& [column, field] : integers_)
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t value = window.stored(field, i);
      std::memcpy(table.cell(begin + i, column), &value, sizeof(value));
    }
}
} // namespace fresco::io::e57
