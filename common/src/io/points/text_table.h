// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_table.h>
#include <string>
#include <string_view>
#include <vector>
/// Tables of numbers as programs and people write them into text files.
namespace fresco::io {
/// How a row is parted into cells: by blanks, tabs, semicolons, bars and, unless they are decimal points, commas.
struct TableDialect {
  bool decimal_comma = false;

  /// A cell may be quoted, or empty between two separators that are no blanks. '#' or "//" begins a comment.
  void split(std::string_view row, std::vector<std::string_view>& cells) const;
};

/// NaN for an empty cell. @throws std::runtime_error naming the cell
double cellNumber(std::string_view cell);

/// By the first rows of numbers. @throws std::runtime_error naming both readings where commas may mean either
TableDialect dialectOf(std::string_view content);

bool isComment(std::string_view line); ///< of at least one character

/// Whether a row is no row of numbers but names them.
bool isHeader(const std::vector<std::string_view>& cells);

/// Standard names of columns, without quotes and units.
std::vector<std::string> namesIn(std::string_view header);

/// Names by values: x y z first; normals have length 1, colours are whole numbers up to 255 or fractions, one further
/// column is the intensity, and more are "column_4" ...
/// @param values rows of `width` >= 3 numbers
/// @throws std::runtime_error naming both readings where two are as likely
std::vector<std::string> guessColumns(const std::vector<double>& values, std::size_t width);

/// Makes packed colours of what a program wrote as whole numbers, into a column rgb or rgba of floats.
void repackWholeNumbers(PointTable& table);

/// "x y z red ..." for messages; "-" = left out.
std::string listOf(const std::vector<std::string>& names);

/// How to say which columns a text file has.
inline constexpr const char* columns_hint = "-columns x,y,z,... says which they are";
} // namespace fresco::io
