// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_table.h>
#include <string>
#include <string_view>
namespace fresco::io {
/// One point a line: x y z and further columns, separated by blanks, commas or semicolons. Lines that begin with '#' or
/// "//" are comments; the last one before the data names the columns if it has one word per column. Without names three
/// columns of whole numbers 0..255 are a colour, three columns within -1..1 a normal, a single one the intensity. A
/// first line with one number (the count of points) is skipped.
/// @throws std::runtime_error naming the line if malformed, or if there are no points
PointTable parseXyz(std::string_view content);

/// A comment with the names of the columns, then one point a line. The sensor pose is not kept.
void writeXyz(const std::string& path, PointTable table);
} // namespace fresco::io
