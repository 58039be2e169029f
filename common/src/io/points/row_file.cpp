// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/row_file.h"
#include "io/files/format_table.h"
#include "io/points/scan_reader.h"
#include <algorithm>
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
    result.path_ = path;
    const RandomAccessFile file(path);
    result.size_ = file.size();
    std::optional<RowLayout> layout = layoutOf(file, format);
    if (!layout || layout->rows == 0 || layout->table.stride == 0)
      return {};
    const std::uint64_t available = file.size() - std::min(layout->offset, file.size());
    expect(available >= layout->bytes_after && layout->rows <= (available - layout->bytes_after) / layout->table.stride,
           "truncated: ", layout->rows, " points of ", layout->table.stride, " bytes do not fit into ", available,
           " bytes");
    result.layout_ = std::move(layout->table);
    result.offset_ = layout->offset;
    result.rows_ = static_cast<Index>(layout->rows);
    result.judgeColors();
    return result;
  });
}

/// By all values, so that no window of rows is judged apart.
void RowFile::judgeColors()
{
  const auto rgb = findTriple(layout_, color_names);
  const auto is_byte = [](const Column& column) { return scalarSize(column.type) == 1; };
  if (!rgb || std::all_of(rgb->begin(), rgb->end(), is_byte))
    return;
  const double largest = parallelReduce(
      rows_, 0, 0.0, [&](Index begin, Index end) { return largestValue(read(begin, end), *rgb); },
      [](double a, double b) { return std::max(a, b); }, rows_per_window);
  for (Column& column : layout_.columns)
    column.full = fullColor((*rgb)[0].type, largest);
}

PointTable RowFile::read(Index begin, Index end) const
{
  PointTable table = layout_;
  table.allocate(end - begin);
  const RandomAccessFile file(path_);
  expect(file.size() == size_, "the file changed while it was read");
  file.read(offset_ + static_cast<std::uint64_t>(begin) * layout_.stride, table.data.data(), table.data.size());
  return table;
}
} // namespace fresco::io
