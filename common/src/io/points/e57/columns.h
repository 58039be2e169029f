// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/e57/vector_reader.h"
#include <fresco/core/point_table.h>
#include <functional>
namespace fresco::io::e57 {
/// The largest values of red, green and blue, of channels of one kind together; those of a scan that says its limits by
/// the first records.
std::array<double, 3> largestColors(PagedFile& file, const Scan& scan);

/// How the fields of a scan become columns of a table.
class Columns {
public:
  /// @param largest_colors see largestColors()
  /// @throws std::runtime_error if the scan has no coordinates
  Columns(const Scan& scan, const std::array<double, 3>& largest_colors);

  const PointTable& layout() const { return layout_; } ///< without rows

  /// Converts the `count` records of the reader's window to rows from `begin` on.
  void store(const VectorReader& window, std::size_t count, PointTable& table, Index begin) const;

private:
  /// A part of a row: value(record of the window) goes to a column.
  using Values = std::function<double(const VectorReader&, std::size_t)>;
  struct Plan {
    Column column;
    Values value;
  };
  std::optional<std::size_t> take(std::string_view name);
  void add(const std::string& name, Scalar type, Values value);
  void addCartesian();
  void addSpherical();
  void addColors(const std::array<double, 3>& largest);
  void addIntensity();
  void addNormals();
  void addOthers();
  void storePositions(const VectorReader& window, std::size_t count, PointTable& table, Index begin) const;

  const Scan& scan_;
  PointTable layout_;
  std::vector<bool> taken_; ///< fields that have a column or are used up
  std::array<std::size_t, 3> position_{};
  std::optional<std::size_t> invalid_; ///< state of the position: 0 = valid
  bool spherical_ = false;
  std::vector<Plan> plans_;                              ///< all but the position
  std::vector<std::pair<Column, std::size_t>> integers_; ///< columns of 64 bits, with their fields
};
} // namespace fresco::io::e57
