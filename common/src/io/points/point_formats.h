// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/scan_reader.h"
#include <string_view>
/// Readers and writers of points, by format: what the table in formats.cpp names.
namespace fresco::io {
/// PCD 0.5 to 0.7: ascii, binary, binary_compressed. Padding columns "_" are left out.
/// @throws std::runtime_error if malformed, truncated or without points
PointTable parsePcd(std::string_view content);

/// PCD 0.7, binary or binary_compressed. VIEWPOINT is written where the table has a sensor pose.
void writePcd(const std::string& path, const PointTable& table, bool compressed);

/// One point a line: x y z and further columns in any of the ways that TableDialect knows. Columns are named by
/// setTextColumns(), else by a header line, else by the last comment before the data, else by guessColumns(), which is
/// remarked. A first line with one number (the count of points) is skipped.
/// @throws std::runtime_error naming the line if malformed, if there are no points, or if it can be read in two ways
PointTable parseXyz(std::string_view content);

/// A comment with the names of the columns, then one point a line; .csv: a header and commas. The sensor pose is not kept.
void writeXyz(const std::string& path, PointTable table);

/// Leica's PTX: stations one after the other, each with its columns and rows, the scanner's place and axes, a matrix to
/// the frame of the file, which may scale, and a line "x y z intensity [r g b [nx ny nz]]" per beam. A beam without a
/// point is "0 0 0 ..." and becomes NaN. A station that cannot be read, or has another number of lines than it announces,
/// has no points and is remarked.
/// @throws std::runtime_error if none can be read
std::unique_ptr<ScanReader> openPtx(const ScanPath& path);

/// Leica's PTS: a line with the number of points, then lines as in PTX; several such blocks are several scans in the same
/// frame. The first block may lack its number. A block that cannot be read has no points and is remarked.
/// @throws std::runtime_error if none can be read
std::unique_ptr<ScanReader> openPts(const ScanPath& path);

/// ASPRS LAS 1.0 to 1.4, point formats 0 to 10: one scan without a pose. Extra bytes are columns, under the names of their
/// descriptors where the file has them. Waveforms are left out.
/// @throws std::runtime_error
std::unique_ptr<ScanReader> openLas(const ScanPath& path);

/// LAS 1.4, point format 6, 7 (colours) or 8 (near infrared); coordinates in steps of a ten millionth of the extent. Fields
/// without a place there become extra bytes, as do intensities that are no whole numbers up to 65535. Points that are not
/// finite are left out.
void writeLas(const std::string& path, PointTable table);

/// The same compressed (LAZ), by the program laszip where it is installed.
/// @throws std::runtime_error that names it where it is not
std::unique_ptr<ScanReader> openLaz(const ScanPath& path);
void writeLaz(const std::string& path, PointTable table);

/// ASTM E2807, "E57": Cartesian or spherical points, packed whole numbers of any width or floats, colours, intensity,
/// normals (extension), row and column, and whatever else the prototype has. Page checksums are verified.
/// @throws std::runtime_error
std::unique_ptr<ScanReader> openE57(const ScanPath& path);

/// One scan, in the frame of its sensor where that is known.
void writeE57Points(const std::string& path, const PointTable& points, bool compressed);
} // namespace fresco::io
