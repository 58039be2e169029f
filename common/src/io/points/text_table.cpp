// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/text_table.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/point_table.h>
#include <limits>
#include <optional>
namespace fresco::io {
namespace {
constexpr std::string_view gaps = " \t";

bool hasOnly(std::string_view text, std::string_view characters)
{
  return text.find_first_not_of(characters) == std::string_view::npos;
}

bool isNumber(std::string_view cell)
{
  constexpr std::string_view digits = "0123456789";
  if (cell.find_first_of(digits) == std::string_view::npos) {
    const std::string_view word = cell.substr(std::min(cell.find_first_not_of("+-"), cell.size()), 3);
    return word == "nan" || word == "NaN" || word == "inf" || word == "Inf";
  }
  return hasOnly(cell, "0123456789+-.,eE") || cell.find(".#") != std::string_view::npos;
}

/// Whether the cells between commas alone are whole numbers of which some look like decimals: "1,05,2,50,7,00".
bool isEitherWay(std::string_view row)
{
  if (!hasOnly(row, "0123456789-,") || std::count(row.begin(), row.end(), ',') < 5)
    return false;
  std::vector<std::string_view> cells;
  TableDialect().split(row, cells);
  for (std::size_t i = 1; i < cells.size(); i += 2)
    if (cells[i].size() > 1 && cells[i][0] == '0')
      return cells.size() % 2 == 0;
  return false;
}

/// Cells of a row where its commas are decimal points; nothing where they cannot be.
std::optional<std::size_t> decimalCells(std::string_view row, bool& any_comma)
{
  std::vector<std::string_view> cells;
  TableDialect{true}.split(row, cells);
  for (const std::string_view cell : cells) {
    const std::size_t comma = cell.find(',');
    any_comma = any_comma || comma != std::string_view::npos;
    if (cell.find('.') != std::string_view::npos || cell.find(',', comma + 1) != std::string_view::npos ||
        cell.find(',') + 1 == cell.size())
      return {};
  }
  return cells.size();
}
} // namespace

void TableDialect::split(std::string_view row, std::vector<std::string_view>& cells) const
{
  cells.clear();
  const std::string_view parts = decimal_comma ? ";|" : ",;|", ends = decimal_comma ? " \t;|" : " \t,;|";
  bool parted = true; // what comes next is a cell, even if it is empty
  for (std::size_t at = row.find_first_not_of(gaps); at < row.size(); at = row.find_first_not_of(gaps, at)) {
    if (row[at] == '#' || row.substr(at, 2) == "//")
      return;
    if (parts.find(row[at]) != std::string_view::npos) {
      if (parted)
        cells.emplace_back();
      parted = true;
      ++at;
      continue;
    }
    const bool quoted = row[at] == '"';
    const std::size_t begin = at + (quoted ? 1 : 0);
    const std::size_t end = std::min(quoted ? row.find('"', begin) : row.find_first_of(ends, begin), row.size());
    cells.push_back(row.substr(begin, end - begin));
    at = std::min(end + (quoted ? 1 : 0), row.size());
    parted = false;
  }
}

double cellNumber(std::string_view cell)
{
  return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : parseNumber<double>(cell);
}

TableDialect dialectOf(std::string_view content)
{
  constexpr int most_rows = 1000;
  TextScanner scanner(content);
  std::optional<std::size_t> width;
  bool decimal = true, any_comma = false;
  std::vector<std::string_view> cells;
  for (int rows = 0; rows < most_rows && !scanner.done();) {
    const std::size_t line = scanner.line();
    const std::string_view row = scanner.restOfLine();
    if (row.empty() || isComment(row))
      continue;
    TableDialect{true}.split(row, cells);
    if (cells.empty() || !std::all_of(cells.begin(), cells.end(), isNumber))
      continue;
    expect(!isEitherWay(row), "line ", line, ": '", row.substr(0, 40), "' may be ",
           std::count(row.begin(), row.end(), ',') + 1, " whole numbers, or ",
           (std::count(row.begin(), row.end(), ',') + 1) / 2,
           " with decimal commas: put ';' or blanks between the columns");
    const auto count = decimalCells(row, any_comma);
    const bool is_count = rows == 0 && cells.size() == 1; // of points, before the first
    decimal = decimal && count && (is_count || (*count >= 3 && *count == width.value_or(*count)));
    if (!is_count)
      width = count;
    ++rows;
  }
  return {decimal && any_comma};
}

bool isComment(std::string_view line) { return line[0] == '#' || line[0] == '%' || line.substr(0, 2) == "//"; }

bool isHeader(const std::vector<std::string_view>& cells)
{
  return std::none_of(cells.begin(), cells.end(), [](std::string_view cell) { return isNumber(cell) || cell.empty(); });
}

std::vector<std::string> namesIn(std::string_view header)
{
  header = trimmed(header, "#/% \t");
  const bool parted = header.find_first_of(",;|\t") != std::string_view::npos;
  const std::string_view parts = parted ? ",;|\t" : " ";
  std::vector<std::string> names;
  for (std::size_t at = 0; at <= header.size();) {
    const std::size_t begin = std::min(header.find_first_not_of(' ', at), header.size());
    const bool quoted = begin < header.size() && header[begin] == '"';
    const std::size_t closed = quoted ? header.find('"', begin + 1) : begin;
    const std::size_t end = std::min(header.find_first_of(parts, closed), header.size());
    const std::string_view cell = trimmed(header.substr(at, end - at), " \t\"'");
    const std::string_view plain = trimmed(cell.substr(0, cell.find_first_of("[(", 1)));
    if (parted || !cell.empty())
      names.push_back(standardName(plain));
    at = end + 1;
  }
  if (!names.empty() && names.back().empty()) // a separator at the end
    names.pop_back();
  return names;
}

void repackWholeNumbers(PointTable& table)
{
  const Column* packed = packedColor(table);
  if (!packed || packed->type != Scalar::float32)
    return;
  constexpr float largest = 4294967296.f;
  bool whole = true, any = false;
  const auto look = [&](Index, auto value) {
    const float v = std::abs(float(value));
    if (v == 0)
      return;
    whole = whole && v >= 1 && v < largest && v == std::floor(v);
    any = true;
  };
  eachValue(table, *packed, look);
  if (!whole || !any)
    return;
  for (Index row = 0; row < table.rows; ++row) {
    std::uint8_t* const at = table.cell(row, *packed);
    const auto bits = std::uint32_t(std::int64_t(loadScalar<float>(at))); // negative ones: modulo 2^32
    std::memcpy(at, &bits, sizeof(bits));
  }
}

std::string listOf(const std::vector<std::string>& names)
{
  std::string list;
  for (const std::string& name : names)
    list += (list.empty() ? "" : " ") + (name.empty() ? "-" : name);
  return list;
}
} // namespace fresco::io
