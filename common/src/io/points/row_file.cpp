// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/row_file.h"
#include "io/files/format_table.h"
#include "io/points/scan_reader.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::io {
namespace {
/// What begins with a header of that kind; nothing if it is malformed: reading it whole then says why.
std::optional<RowLayout> layoutOf(const RandomAccessFile& file, const Format& format)
{
  constexpr std::uint64_t longest_header = std::uint64_t{1} << 20;
  std::string begin(std::min(file.size(), longest_header), '\0');
  file.read(0, begin.data(), begin.size());
  try {
    return format.row_layout(begin);
  } catch (const std::runtime_error&) {
    return {};
  }
}
} // namespace

std::optional<RowFile> RowFile::open(const std::string& path)
{
  const Format& format = formatToRead(path, FileKind::points);
  if (!format.row_layout)
    return {};
  return namingFile(path, [&]() -> std::optional<RowFile> {
    RowFile result;
    result.file_ = std::make_shared<RandomAccessFile>(path);
    std::optional<RowLayout> layout = layoutOf(*result.file_, format);
    if (!layout || layout->rows == 0 || layout->table.stride == 0)
      return {};
    const std::uint64_t available = result.file_->size() - std::min(layout->offset, result.file_->size());
    if (available < layout->bytes_after || layout->rows > (available - layout->bytes_after) / layout->table.stride)
      throw std::runtime_error(concat("truncated: ", layout->rows, " points of ", layout->table.stride,
                                      " bytes do not fit into ", available, " bytes"));
    result.layout_ = std::move(layout->table);
    result.offset_ = layout->offset;
    result.rows_ = static_cast<Index>(layout->rows);
    return result;
  });
}

PointTable RowFile::read(Index begin, Index end) const
{
  PointTable table = layout_;
  table.allocate(end - begin);
  file_->read(offset_ + static_cast<std::uint64_t>(begin) * layout_.stride, table.data.data(), table.data.size());
  return table;
}
} // namespace fresco::io
