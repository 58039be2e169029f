// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/scan_reader.h"
namespace fresco::io {
/// Leica's PTX: stations one after the other, each with its columns and rows, the scanner's place and axes, a matrix to
/// the frame of the file, which may scale, and a line "x y z intensity [r g b [nx ny nz]]" per beam. A beam without a
/// point is "0 0 0 ..." and becomes NaN. A station that cannot be read, or has another number of lines than it announces,
/// has no points and is remarked.
/// @throws std::runtime_error if none can be read
std::unique_ptr<ScanReader> openPtx(const std::string& path);

/// Leica's PTS: a line with the number of points, then lines as in PTX; several such blocks are several scans in the same
/// frame. The first block may lack its number. A block that cannot be read has no points and is remarked.
/// @throws std::runtime_error if none can be read
std::unique_ptr<ScanReader> openPts(const std::string& path);
} // namespace fresco::io
