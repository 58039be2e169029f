// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/file_window.h"
#include <fresco/core/point_table.h>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
namespace fresco::io {
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
