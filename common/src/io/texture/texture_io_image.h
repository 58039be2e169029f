// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/image.h>
#include <string_view>
namespace fresco::io {
inline bool startsWith(std::string_view bytes, std::string_view mark) { return bytes.substr(0, mark.size()) == mark; }

/// Whether all chunks of a PNG are there and their check sums hold; libpng prints on stderr where they do not.
bool isIntactPng(const unsigned char* bytes, std::size_t size);

/// RGB image from the bytes of a PNG or JPEG file. @throws std::runtime_error if it is damaged or none of the two
Image decodeImage(const unsigned char* bytes, std::size_t size);
} // namespace fresco::io
