// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/image.h>
#include <string_view>
namespace fresco::io {
/// RGB image from the bytes of a PNG, JPEG, TIFF, BMP or WebP file.
/// @throws std::runtime_error if it is damaged, truncated, smaller than its size asks for or none of these
Image decodeImage(std::string_view bytes);

/// @throws std::runtime_error as decodeImage, and if the image is not 16 bit with one channel
Image16 decodeImage16(std::string_view bytes);
} // namespace fresco::io
