// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_stream.h>
#include <fresco/io/scan_file.h>
#include <memory>
namespace fresco {
/// Points that are handed over at a time: 50 MB.
inline constexpr Index points_per_window = Index{1} << 21;

/// A part of the windows of a cloud that several ranks read together.
struct WindowShare {
  Index part = 0, parts = 1;
};

/// The points of files as one cloud, in windows, with the attributes that all of them have, without viewpoints. Rows of
/// binary PLY without faces and of binary PCD are read window by window. Other files are read whole, one at a time; a
/// single one of them stays in memory, as do files that fit into one window. Which points there are, and their bits, does
/// not depend on the order of the files or on the window.
/// @param share every parts-th window; files that are read whole are one window each
/// @throws std::runtime_error "PATH: reason" if a file cannot be read, std::invalid_argument for no files or `window` < 1
FRESCO_EXPORT std::unique_ptr<PointStream>
openPointFiles(const std::vector<ScanPath>& files, Index window = points_per_window, const WindowShare& share = {});

/// Folders replaced by the files of points in them, in the order of their names; other words stay. Text files there are
/// notes or poses, .stl files hold no scans, and hidden files do not count.
/// @throws std::runtime_error "PATH: reason" if a word is no file, or a folder has no file of points
FRESCO_EXPORT std::vector<std::string> pointFilesIn(const std::vector<std::string>& words);
} // namespace fresco
