// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/e57/vector_reader.h"
#include <fresco/core/point_table.h>
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
  using Names = std::vector<std::pair<const char*, const char*>>; ///< of fields and their columns
  struct Plan {
    Column column;
    std::size_t field;
    std::optional<std::size_t> invalid; ///< field that is not 0 where there is no value
    std::optional<Limits> color;        ///< what stands for 0 and 255
  };
  std::optional<std::size_t> find(const char* name) const;
  const char* missing(const Names& names) const;
  bool add(const Names& names, Scalar type, const char* state = "");
  void addOthers();

  const Scan& scan_;
  PointTable layout_;
  std::vector<bool> taken_; ///< fields that have a column or are used up
  bool spherical_;
  std::vector<Plan> plans_;
};
} // namespace fresco::io::e57
