// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/scan_reader.h"
namespace fresco::io {
/// ASPRS LAS 1.0 to 1.4, point formats 0 to 10, not compressed: one scan without a pose. Extra bytes and waveforms are
/// left out.
/// @throws std::runtime_error, for compressed points with a word on how to convert them
std::unique_ptr<ScanReader> openLas(const std::string& path);

/// How to make .las of .laz.
inline constexpr const char* laz_hint =
    "compressed (LAZ), which is not read: convert it first, as by `laszip -i IN.laz -o OUT.las`";
} // namespace fresco::io
