// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/scan_reader.h"
namespace fresco::io {
/// ASPRS LAS 1.0 to 1.4, point formats 0 to 10: one scan without a pose. Extra bytes are columns, under the names of their
/// descriptors where the file has them. Waveforms are left out.
/// @throws std::runtime_error
std::unique_ptr<ScanReader> openLas(const std::string& path);

/// LAS 1.4, point format 6, 7 (colours) or 8 (near infrared); coordinates in steps of a ten millionth of the extent. Fields
/// without a place there become extra bytes, as do intensities that are no whole numbers up to 65535. Points that are not
/// finite are left out.
void writeLas(const std::string& path, PointTable table);

/// The same compressed (LAZ), by the program laszip where it is installed.
/// @throws std::runtime_error, laz_hint where it is not
std::unique_ptr<ScanReader> openLaz(const std::string& path);
void writeLaz(const std::string& path, PointTable table);

inline constexpr const char* laz_hint =
    "compressed (LAZ): install the program laszip, which reads and writes it, or use .las";
} // namespace fresco::io
