// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/files/expect.h"
#include "io/points/file_window.h"
#include <fresco/core/point_table.h>
#include <optional>
#include <string>
#include <string_view>
namespace fresco::io {
/// @throws std::runtime_error unless so many rows fit into what is left of a file
inline void expectRows(std::uint64_t rows, std::size_t row_bytes, std::uint64_t available)
{
  expect(rows <= available / row_bytes, "truncated: ", rows, " points of ", row_bytes, " bytes do not fit into ",
         available, " bytes");
}

/// Where the rows of a file begin that are in the file what they are in memory.
struct RowLayout {
  PointTable table; ///< columns and bytes per row, without rows
  std::uint64_t offset = 0, rows = 0;
  std::uint64_t bytes_after = 0; ///< at least, of what else the file holds
};

/// From the begin of a file, at least its header; nothing where rows have no fixed size, or where the reader of whole
/// files has something to say against it.
std::optional<RowLayout> plyRows(std::string_view begin);
std::optional<RowLayout> pcdRows(std::string_view begin);

/// Each value of a row as a column of its own: NAME_0, NAME_1 ... where a column has several.
inline std::vector<Column> singleValues(const std::vector<Column>& columns)
{
  std::vector<Column> values;
  for (const Column& column : columns)
    for (std::size_t k = 0; k < column.count; ++k)
      values.push_back({column.name + (column.count > 1 ? concat('_', k) : ""), column.type, 1,
                        column.offset + k * scalarSize(column.type), column.full});
  return values;
}

/// A file of rows of fixed size, read at any place. It is open only while it is read, since there may be thousands.
class RowFile {
public:
  /// @return nothing if the file is not of that kind
  /// @throws std::runtime_error "PATH: reason" if it cannot be opened or has fewer rows than it announces
  static std::optional<RowFile> open(const std::string& path);

  Index size() const { return rows_; }
  const PointTable& layout() const { return layout_; }
  /// Rows begin .. end - 1. @throws std::runtime_error if the file has changed its size
  PointTable read(Index begin, Index end) const;

private:
  void judgeColors();
  std::string path_;
  std::uint64_t size_ = 0; ///< bytes of the file
  PointTable layout_;
  std::uint64_t offset_ = 0;
  Index rows_ = 0;
};
} // namespace fresco::io
