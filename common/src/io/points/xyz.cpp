// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/point_formats.h"
#include "io/points/row_file.h"
#include "io/points/text_numbers.h"
#include "io/points/text_table.h"
#include <algorithm>
#include <optional>
#include <utility>
namespace fresco::io {
namespace {
/// The rows of a file, and what names their columns.
class TextCloud {
public:
  explicit TextCloud(std::string_view content) : dialect_(dialectOf(content)), scanner_(content) {}

  PointTable table()
  {
    while (!scanner_.done()) {
      const std::size_t number = scanner_.line();
      try {
        addLine(scanner_.restOfLine());
      } catch (const std::runtime_error& error) {
        throw std::runtime_error(concat("line ", number, ": ", error.what()));
      }
    }
    expect(!values_.empty(), "no points");
    if (announced_ && *announced_ != values_.size() / width_)
      remark(concat(*announced_, " points announced, ", values_.size() / width_, " there"));
    return tableOfRows(names(), values_);
  }

private:
  void addLine(std::string_view line)
  {
    if (line.empty())
      return;
    if (isComment(line)) {
      if (values_.empty())
        comment_ = line;
      return;
    }
    dialect_.split(line, cells_);
    if (values_.empty() && header_.empty() && isHeader(cells_))
      header_ = line;
    else if (values_.empty() && !announced_ && cells_.size() == 1)
      announced_ = parseNumber<std::uint64_t>(cells_[0]);
    else
      addRow(line);
  }

  void addRow(std::string_view line)
  {
    const std::size_t expected = width_ > 0 || header_.empty() ? width_ : namesIn(header_).size();
    if (cells_.size() + 1 == expected && line.find_last_of(",;|") + 1 == line.size())
      cells_.emplace_back(); // empty, behind the last separator
    if (width_ == 0)
      width_ = cells_.size();
    expect(cells_.size() >= 3 && cells_.size() == width_, cells_.size(), " columns, expected ",
           std::max<std::size_t>(width_, 3));
    for (const std::string_view cell : cells_)
      values_.push_back(cellNumber(cell));
  }

  static bool hasPosition(const std::vector<std::string>& names)
  {
    return std::all_of(xyz_names, xyz_names + 3,
                       [&](const char* axis) { return std::count(names.begin(), names.end(), axis) > 0; });
  }

  /// What the user says, else the header, else a comment that fits, else the values.
  std::vector<std::string> names() const
  {
    if (std::vector<std::string> told = textColumns(); !told.empty()) {
      expect(told.size() == width_, "it has ", width_, " columns, but -columns names ", told.size());
      return told;
    }
    if (!header_.empty()) {
      std::vector<std::string> named = namesIn(header_);
      expect(named.size() == width_ && hasPosition(named), "the header '", header_.substr(0, 60), "' names ",
             named.size(), " columns", hasPosition(named) ? "" : ", of which none is x, y or z", ", the rows have ",
             width_, ": ", columns_hint);
      return named;
    }
    if (!comment_.empty())
      if (std::vector<std::string> named = namesIn(comment_); named.size() == width_ && hasPosition(named))
        return named;
    std::vector<std::string> guessed = guessColumns(values_, width_);
    if (width_ > 3)
      remark(concat("no names of columns: read by their values as ", listOf(guessed), "; ", columns_hint));
    return guessed;
  }

  const TableDialect dialect_;
  TextScanner scanner_;
  std::vector<std::string_view> cells_;
  std::vector<double> values_;
  std::size_t width_ = 0;
  std::string_view header_, comment_; ///< before the points
  std::optional<std::uint64_t> announced_;
};
} // namespace

PointTable parseXyz(std::string_view content)
{
  constexpr std::string_view mark = "\xEF\xBB\xBF"; // of UTF-8, as spreadsheets write it
  return TextCloud(content.substr(content.substr(0, 3) == mark ? 3 : 0)).table();
}

void writeXyz(const std::string& path, PointTable table)
{
  unpackColors(table);
  const bool csv = extension(path) == ".csv";
  const char* const between = csv ? "," : " ";
  OutputFile file(path);
  const std::vector<Column> columns = singleValues(table.columns);
  const char* separator = csv ? "" : "# ";
  for (const Column& column : columns)
    file.write(textOf(std::exchange(separator, between), plainName(column.name)));
  for (Index row = 0; row < table.rows; ++row) {
    separator = "\n";
    for (const Column& column : columns)
      visitScalar(column.type, [&](auto zero) {
        const auto value = loadScalar<decltype(zero)>(table.cell(row, column));
        file.write(textOf(std::exchange(separator, between), value));
      });
  }
  file.write("\n");
  file.commit();
}
} // namespace fresco::io
