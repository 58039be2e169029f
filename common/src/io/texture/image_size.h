// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <string_view>
namespace fresco::io {
/// Width times height that the header of a TIFF, BMP or WebP image tells; 0 if it tells none.
std::uint64_t pixelsOf(std::string_view image);
} // namespace fresco::io
