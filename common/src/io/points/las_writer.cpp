// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/las_fields.h"
#include "io/points/point_formats.h"
#include "io/points/row_file.h"
#include <algorithm>
#include <cmath>
#include <fresco/io/file.h>
namespace fresco::io {
namespace {
constexpr std::size_t header_bytes = 375, record_head = 54;

template <typename T>
void put(std::string& bytes, std::size_t at, T value)
{
  bytes.replace(at, sizeof(T), reinterpret_cast<const char*>(&value), sizeof(T));
}

bool isWhole16(const PointTable& table, const Column& column)
{
  bool whole = true;
  eachValue(table, column, [&](Index, auto value) {
    const auto v = double(value);
    whole = whole && v >= 0 && v <= 65535 && v == std::floor(v);
  });
  return whole;
}

/// How a table becomes records: fields of the format, then extra bytes.
class Layout {
public:
  Layout(const PointTable& table, const std::array<Column, 3>& xyz)
      : table_(table), bounds_(coordinateBounds(table, xyz))
  {
    const bool colors = table.find("red") != nullptr;
    format_ = !colors ? 6 : table.find("near_infrared") ? 8 : 7;
    placeCoordinates();
    fields_ = lasFields(format_, Eigen::Array3d::Constant(scale_), offset_);
    record_ = lasRecordBytes(format_);
    std::vector<Column> others;
    for (const Column& column : table.columns)
      if (std::none_of(fields_.begin(), fields_.end(), [&](const auto& f) { return f.name == column.name; }) ||
          (column.name == "intensity" && !isWhole16(table, column)))
        others.push_back(column);
    extra_ = singleValues(others);
    for (const Column& one : extra_)
      record_ += one.bytes();
    require(record_ <= 65535, "too many fields for LAS");
  }

  std::string header(std::uint64_t points) const
  {
    std::string descriptors;
    for (const Column& column : extra_)
      descriptors += lasExtraDescriptor(column);
    const std::size_t more = extra_.empty() ? 0 : record_head + descriptors.size();
    expect(descriptors.size() <= 65535, "too many fields for LAS");
    std::string bytes(header_bytes + more, '\0');
    bytes.replace(0, 4, "LASF");
    put<std::uint16_t>(bytes, 6, 1 << 4); // coordinate systems as text
    put<std::uint8_t>(bytes, 24, 1);
    put<std::uint8_t>(bytes, 25, 4);
    bytes.replace(26, 6, "fresco");
    bytes.replace(58, 6, "fresco");
    put<std::uint16_t>(bytes, 94, header_bytes);
    put<std::uint32_t>(bytes, 96, bytes.size());
    put<std::uint32_t>(bytes, 100, extra_.empty() ? 0 : 1);
    put<std::uint8_t>(bytes, 104, format_);
    put<std::uint16_t>(bytes, 105, record_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(bytes, 131 + 8 * axis, scale_);
      put(bytes, 155 + 8 * axis, offset_[Index(axis)]);
      put(bytes, 179 + 16 * axis, bounds_.high[Index(axis)]);
      put(bytes, 187 + 16 * axis, bounds_.low[Index(axis)]);
    }
    put<std::uint64_t>(bytes, 247, points);
    put<std::uint64_t>(bytes, 255, points); // first returns: all, unless a column says more
    if (!extra_.empty()) {
      bytes.replace(header_bytes + 2, 9, "LASF_Spec");
      put<std::uint16_t>(bytes, header_bytes + 18, 4);
      put<std::uint16_t>(bytes, header_bytes + 20, descriptors.size());
      bytes.replace(header_bytes + record_head, descriptors.size(), descriptors);
    }
    return bytes;
  }

  std::string record(Index row) const
  {
    std::string bytes(record_, '\0');
    bytes[14] = 0x11; // one return of one
    for (const LasField& field : fields_)
      if (const Column* column = table_.find(field.name))
        storeField(field, *column, row, bytes.data());
    std::size_t at = lasRecordBytes(format_);
    for (const Column& column : extra_) {
      std::memcpy(&bytes[at], table_.cell(row, column), column.bytes());
      at += column.bytes();
    }
    return bytes;
  }

private:
  /// Steps of a ten millionth of the extent at most, so that 32 bits hold it.
  void placeCoordinates()
  {
    const double extent = std::max(bounds_.extent(), 1e-6);
    scale_ = std::pow(10.0, std::floor(std::log10(extent)) - 7);
    offset_ = bounds_.origin().array();
  }

  void storeField(const LasField& field, const Column& column, Index row, char* record) const
  {
    double value = valueAt(table_, row, column);
    if (field.name == "intensity" && !extra_.empty() &&
        std::any_of(extra_.begin(), extra_.end(), [](const Column& c) { return c.name == "intensity"; }))
      return;                                                            // its exact values are extra bytes
    if (field.stored == Scalar::uint16 && field.column == Scalar::uint8) // colours: 0..255 as 0..65535
      value *= 257;
    value = std::isnan(value) ? 0 : (value - field.origin) / field.scale;
    if (field.bits > 0) {
      const unsigned mask = (1U << field.bits) - 1, whole = std::clamp<double>(value, 0, mask);
      record[field.offset] = char((std::uint8_t(record[field.offset]) & ~(mask << field.shift)) | whole << field.shift);
      return;
    }
    storeValue(field.stored, value, record + field.offset);
  }

  const PointTable& table_;
  const CoordinateBounds bounds_;
  int format_ = 6;
  double scale_ = 1;
  Eigen::Array3d offset_;
  std::vector<LasField> fields_;
  std::vector<Column> extra_;
  std::size_t record_ = 0;
};
} // namespace

void writeLas(const std::string& path, PointTable table)
{
  namingFile(path, [&] {
    unpackColors(table);
    const auto xyz = findTriple(table, xyz_names);
    expect(xyz.has_value(), "no coordinates x y z");
    const std::vector<bool> finite = finiteRows(table);
    const Index count = std::count(finite.begin(), finite.end(), true);
    if (count < table.rows)
      remark(concat(table.rows - count, " points that are not finite have no place in LAS: left out"));
    const Layout layout(table, *xyz);
    OutputFile file(path);
    file.write(layout.header(count));
    for (Index row = 0; row < table.rows; ++row)
      if (finite[row])
        file.write(layout.record(row));
    file.commit();
  });
}
} // namespace fresco::io
