// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <functional>
#include <string>
#include <vector>
/// How files are read, for the whole process: what readers remark, and what text files cannot say themselves.
namespace fresco {
/// Gets a line "PATH: ..." for each guess that a reader made, each field that it left out and each part that it could not
/// read. Called from any thread; a file that is read twice is remarked on twice.
using ReadingListener = std::function<void(const std::string& line)>;

/// @param listener empty: nobody listens, as at the start
FRESCO_EXPORT void listenToReaders(ReadingListener listener);

/// Names of the columns of text clouds (.xyz .txt .asc .csv), for all that are read from now on, whatever their headers
/// say: x y z intensity red green blue nx ny nz or short forms; others become fields of that name, "-" is left out.
/// @param names empty: as the files say, as at the start
/// @throws std::invalid_argument unless x y z are among them once
FRESCO_EXPORT void setTextColumns(const std::vector<std::string>& names);

/// What setTextColumns() said, by standard names: "normal_x" for "nx"; "" = left out.
FRESCO_EXPORT std::vector<std::string> textColumns();
} // namespace fresco
