// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/image.h>
#include <string_view>
namespace fresco::io {
/// RGB image from the bytes of a JPEG file, by libjpeg. OpenCV lets the library print what is wrong and fill in what is
/// missing; here that is an error. CMYK is converted without a colour profile, EXIF orientation not applied.
/// @throws std::runtime_error with the library's words if the file is damaged, or too small for the size it gives
Image decodeJpeg(std::string_view bytes);
} // namespace fresco::io
