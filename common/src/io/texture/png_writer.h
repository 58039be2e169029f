// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/image.h>
#include <vector>
namespace fresco::io {
/// PNG (ISO/IEC 15948), without loss. Bands of rows are compressed in parallel, each in a chunk of its own.
/// @param image that is not empty
std::vector<std::uint8_t> encodePng(const Image& image);
} // namespace fresco::io
