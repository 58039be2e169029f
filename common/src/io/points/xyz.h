// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_table.h>
#include <string>
#include <string_view>
namespace fresco::io {
/// One point a line: x y z and further columns in any of the ways that TableDialect knows. Columns are named by
/// setTextColumns(), else by a header line, else by the last comment before the data, else by guessColumns(), which is
/// remarked. A first line with one number (the count of points) is skipped.
/// @throws std::runtime_error naming the line if malformed, if there are no points, or if it can be read in two ways
PointTable parseXyz(std::string_view content);

/// A comment with the names of the columns, then one point a line; .csv: a header and commas. The sensor pose is not kept.
void writeXyz(const std::string& path, PointTable table);
} // namespace fresco::io
