// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/vector_reader.h"
#include "io/points/point_formats.h"
#include <algorithm>
#include <cmath>
#include <limits>
namespace fresco::io {
namespace e57 {
namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The smallest type that holds all values of a field.
Scalar typeFor(const Field& field)
{
  if (field.type == Field::Type::single_float)
    return Scalar::float32;
  if (field.type != Field::Type::integer)
    return Scalar::float64;
  for (const Scalar type :
       {Scalar::uint8, Scalar::int8, Scalar::uint16, Scalar::int16, Scalar::uint32, Scalar::int32}) {
    const bool fits = visitScalar(type, [&](auto zero) {
      using Limits = std::numeric_limits<decltype(zero)>;
      return field.minimum >= std::int64_t(Limits::min()) && field.maximum <= std::int64_t(Limits::max());
    });
    if (fits)
      return type;
  }
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

/// The largest values of red, green and blue, of channels of one kind together; those of a scan that says its limits by
/// the first records.
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

/// How the fields of a scan become columns of a table.
class Columns {
public:
  /// @param largest_colors see largestColors()
  /// @throws std::runtime_error if the scan has no coordinates
  Columns(const Scan& scan, const std::array<double, 3>& largest_colors)
      : scan_(scan), taken_(scan.records.fields.size(), false), spherical_(!scan.records.find("cartesianX"))
  {
    const Names cartesian = {{"cartesianX", "x"}, {"cartesianY", "y"}, {"cartesianZ", "z"}};
    const Names spherical = {{"sphericalRange", "x"}, {"sphericalAzimuth", "y"}, {"sphericalElevation", "z"}};
    const bool single = std::all_of(cartesian.begin(), cartesian.end(), [&](const auto& names) {
      const auto field = scan.records.find(names.first);
      return field && scan.records.fields[*field].type == Field::Type::single_float;
    });
    if (!add(spherical_ ? spherical : cartesian, single ? Scalar::float32 : Scalar::float64,
             spherical_ ? "sphericalInvalidState" : "cartesianInvalidState"))
      throw std::runtime_error(concat("no coordinates: no field ", missing(spherical_ ? spherical : cartesian)));
    add({{"normalX", "normal_x"}, {"normalY", "normal_y"}, {"normalZ", "normal_z"}}, Scalar::float32);
    if (add({{color_fields[0], "red"}, {color_fields[1], "green"}, {color_fields[2], "blue"}}, Scalar::uint8,
            "isColorInvalid")) {
      if (const auto state = scan.records.find("isColorInvalid"))
        taken_[*state] = false; // a column, too: black may be a colour
      for (std::size_t channel = 0; channel < 3; ++channel) {
        Plan& plan = plans_[plans_.size() - 3 + channel];
        const Field& stored = scan.records.fields[plan.field];
        plan.color = colorLimits(saidLimits(scan.color[channel], stored), stored, largest_colors[channel]);
      }
    }
    add({{"intensity", "intensity"}}, Scalar::float32, "isIntensityInvalid");
    addOthers();
  }

  const PointTable& layout() const { return layout_; } ///< without rows

  /// Converts the `count` records of the reader's window to rows from `begin` on.
  void store(const VectorReader& window, std::size_t count, PointTable& table, Index begin) const
  {
    for (const auto& [column, field, invalid, color] : plans_)
      for (std::size_t i = 0; i < count; ++i) {
        std::uint8_t* const cell = table.cell(begin + i, column);
        if (invalid && window.real(*invalid, i) != 0) {
          storeValue(column.type, nan, cell); // a colour: 0
        } else if (column.type == Scalar::int64) {
          const std::int64_t value = window.stored(field, i);
          std::memcpy(cell, &value, sizeof(value));
        } else {
          const double value = window.real(field, i);
          storeValue(column.type, color ? byteWithin(value, *color) : value, cell);
        }
      }
    for (std::size_t i = 0; spherical_ && i < count; ++i) {
      std::uint8_t* const cell = table.cell(begin + i, layout_.columns[0]); // y and z follow x
      const auto place = loadScalar<std::array<double, 3>>(cell);
      const Eigen::Vector3d point = fromSpherical(place[0], place[1], place[2]);
      std::memcpy(cell, point.data(), sizeof(point));
    }
  }

private:
  using Names = std::vector<std::pair<const char*, const char*>>; ///< of fields and their columns
  struct Plan {
    Column column;
    std::size_t field;
    std::optional<std::size_t> invalid; ///< field that is not 0 where there is no value
    std::optional<Limits> color;        ///< what stands for 0 and 255
  };

  /// Index of a field of numbers.
  std::optional<std::size_t> find(const char* name) const
  {
    const auto field = scan_.records.find(name);
    return field && scan_.records.fields[*field].type != Field::Type::string ? field : std::nullopt;
  }

  /// The first of the fields that is not there; nullptr: all are.
  const char* missing(const Names& names) const
  {
    const auto found = std::find_if(names.begin(), names.end(), [&](const auto& pair) { return !find(pair.first); });
    return found == names.end() ? nullptr : found->first;
  }

  /// Adds columns of fields. @param state field that is not 0 where a value is invalid @return false if one is missing
  bool add(const Names& names, Scalar type, const char* state = "")
  {
    if (missing(names))
      return false;
    const auto invalid = find(state);
    if (invalid)
      taken_[*invalid] = true;
    for (const auto& [field, column] : names) {
      layout_.addColumn(column, type);
      plans_.push_back({layout_.columns.back(), *find(field), invalid, {}});
      taken_[plans_.back().field] = true;
    }
    return true;
  }

  void addOthers()
  {
    const std::vector<Field>& fields = scan_.records.fields;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (fields[f].type == Field::Type::string)
        remark(concat("field ", fields[f].name, " is left out: it holds texts"));
      const std::string name = fields[f].own ? fields[f].name : columnName(fields[f].name);
      if (taken_[f] || fields[f].type == Field::Type::string || layout_.find(name))
        continue;
      layout_.addColumn(name, typeFor(fields[f]));
      plans_.push_back({layout_.columns.back(), f, {}, {}});
    }
  }

  const Scan& scan_;
  PointTable layout_;
  std::vector<bool> taken_; ///< fields that have a column or are used up
  bool spherical_;
  std::vector<Plan> plans_;
};

class Reader : public ScanReader {
public:
  explicit Reader(const std::string& path) : file_(path), content_(parseContent(file_))
  {
    for (const Scan& scan : content_.scans)
      scans_.push_back(scan.info);
    tellDamage(content_.errors, hasPoints());
  }

  PointTable open(Index scan) override
  {
    const Scan& chosen = content_.scans[scan];
    scan_ = scan;
    read_ = 0;
    columns_.emplace(chosen, largestColors(file_, chosen));
    records_.emplace(file_, chosen.records);
    const PointTable& layout = columns_->layout();
    // Fields of no bits cost nothing in the file.
    constexpr std::uint64_t least = std::uint64_t{1} << 26, per_byte = 64;
    expect(chosen.records.count <= std::max(least, per_byte * file_.size()) / layout.stride,
           "truncated: ", chosen.records.count, " points of ", layout.stride, " bytes do not fit into a file of ",
           file_.size());
    return layout;
  }

  Index read(PointTable& table, Index begin, Index end) override
  {
    const std::size_t count = records_->next(std::min(end - begin, rows_per_window));
    columns_->store(*records_, count, table, begin);
    read_ += count;
    if (content_.is_doubtful && read_ == content_.scans[scan_].info.points)
      records_->requireEnd();
    return count;
  }

private:
  PagedFile file_;
  const Content content_;
  std::optional<Columns> columns_;
  std::optional<VectorReader> records_;
  Index scan_ = 0, read_ = 0; ///< that is read, and how many of its records
};
} // namespace
} // namespace e57

std::unique_ptr<ScanReader> openE57(const ScanPath& path) { return std::make_unique<e57::Reader>(path.file); }
} // namespace fresco::io
