// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/xyz.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
namespace fresco::io {
namespace {
struct Rows {
  std::vector<double> values;
  std::size_t width = 0;         ///< values per row
  std::string_view last_comment; ///< before the data
};

bool isSeparator(char c) { return c == ' ' || c == '\t' || c == ',' || c == ';'; }

/// Words of a line.
void splitLine(std::string_view line, std::vector<std::string_view>& words)
{
  words.clear();
  for (std::size_t at = 0; at < line.size();) {
    while (at < line.size() && isSeparator(line[at]))
      ++at;
    const std::size_t begin = at;
    while (at < line.size() && !isSeparator(line[at]))
      ++at;
    if (at > begin)
      words.push_back(line.substr(begin, at - begin));
  }
}

bool isComment(std::string_view line) { return line[0] == '#' || line.substr(0, 2) == "//"; }

/// The first line may hold the number of points alone. @return false if the line was that
bool addRow(const std::vector<std::string_view>& words, bool first, Rows& rows)
{
  if (first && words.size() == 1) {
    parseNumber<std::uint64_t>(words[0]);
    return false;
  }
  if (rows.width == 0)
    rows.width = words.size();
  if (words.size() < 3 || words.size() != rows.width)
    throw std::runtime_error(concat(words.size(), " columns, expected ", std::max<std::size_t>(rows.width, 3)));
  for (const std::string_view word : words)
    rows.values.push_back(parseNumber<double>(word));
  return true;
}

Rows parseRows(std::string_view content)
{
  Rows rows;
  TextScanner scanner(content);
  std::vector<std::string_view> words;
  bool first = true;
  while (!scanner.done()) {
    const std::size_t number = scanner.line();
    const std::string_view line = scanner.restOfLine();
    if (line.empty())
      continue;
    if (isComment(line)) {
      if (rows.values.empty())
        rows.last_comment = line;
      continue;
    }
    splitLine(line, words);
    try {
      addRow(words, first, rows);
    } catch (const std::exception& error) {
      throw std::runtime_error(concat("line ", number, ": ", error.what()));
    }
    first = false;
  }
  if (rows.values.empty())
    throw std::runtime_error("no points");
  return rows;
}

std::string standardName(std::string_view word)
{
  std::string name(word);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  static constexpr std::pair<const char*, const char*> names[] = {
      {"nx", "normal_x"}, {"ny", "normal_y"}, {"nz", "normal_z"}, {"r", "red"},
      {"g", "green"},     {"b", "blue"},      {"i", "intensity"}, {"scalar_intensity", "intensity"}};
  for (const auto& [from, to] : names)
    if (name == from)
      return to;
  return name;
}

/// Names that a comment gives, empty if they do not fit.
std::vector<std::string> namesFromComment(const Rows& rows)
{
  std::string_view comment = rows.last_comment;
  while (!comment.empty() && (comment[0] == '#' || comment[0] == '/'))
    comment.remove_prefix(1);
  std::vector<std::string_view> words;
  splitLine(comment, words);
  std::vector<std::string> names(words.size());
  std::transform(words.begin(), words.end(), names.begin(), standardName);
  const bool fits = names.size() == rows.width && std::equal(std::begin(xyz_names), std::end(xyz_names), names.begin());
  return fits ? names : std::vector<std::string>();
}

/// Whether all finite values of three columns fulfil `test`.
template <typename Test>
bool allOf(const Rows& rows, std::size_t column, const Test& test)
{
  for (std::size_t at = column; at < rows.values.size(); at += rows.width)
    for (std::size_t k = 0; k < 3; ++k)
      if (std::isfinite(rows.values[at + k]) && !test(rows.values[at + k]))
        return false;
  return true;
}

bool looksLikeColor(const Rows& rows, std::size_t column)
{
  return allOf(rows, column, [](double value) { return value >= 0 && value <= 255 && value == std::floor(value); });
}

bool looksLikeNormal(const Rows& rows, std::size_t column)
{
  return allOf(rows, column, [](double value) { return std::abs(value) <= 1.001; });
}

std::vector<std::string> guessNames(const Rows& rows)
{
  std::vector<std::string> names(std::begin(xyz_names), std::end(xyz_names));
  bool color = false, normal = false, intensity = false;
  while (names.size() < rows.width) {
    const std::size_t at = names.size();
    const bool triple = at + 3 <= rows.width;
    if (triple && !color && looksLikeColor(rows, at)) {
      names.insert(names.end(), std::begin(color_names), std::end(color_names));
      color = true;
    } else if (triple && !normal && looksLikeNormal(rows, at)) {
      names.insert(names.end(), std::begin(normal_names), std::end(normal_names));
      normal = true;
    } else {
      names.push_back(intensity ? concat("column_", at + 1) : "intensity");
      intensity = true;
    }
  }
  return names;
}

std::string writtenName(const std::string& column)
{
  for (const char axis : {'x', 'y', 'z'})
    if (column == std::string("normal_") + axis)
      return std::string("n") + axis;
  return singleWord(column);
}

void writeRow(TextWriter& writer, const PointTable& table, Index row)
{
  const char* separator = "";
  for (const Column& column : table.columns)
    visitScalar(column.type, [&](auto zero) {
      using T = decltype(zero);
      for (std::size_t k = 0; k < column.count; ++k) {
        writer.text(separator).number(loadScalar<T>(table.cell(row, column) + k * sizeof(T)));
        separator = " ";
      }
    });
  writer.text("\n");
}
} // namespace

PointTable parseXyz(std::string_view content)
{
  const Rows rows = parseRows(content);
  const std::vector<std::string> names = namesFromComment(rows);
  return tableOfRows(names.empty() ? guessNames(rows) : names, rows.values);
}

void writeXyz(const std::string& path, PointTable table)
{
  unpackColors(table);
  OutputFile file(path);
  TextWriter writer(file);
  writer.text("#");
  for (const Column& column : table.columns)
    for (std::size_t k = 0; k < column.count; ++k)
      writer.text(" ").text(writtenName(column.name)).text(column.count > 1 ? concat('_', k) : std::string());
  writer.text("\n");
  for (Index row = 0; row < table.rows; ++row)
    writeRow(writer, table, row);
  writer.flush();
  file.commit();
}
} // namespace fresco::io
