// SPDX-License-Identifier: BSD-3-Clause
#pragma once
namespace fresco::io {
/// To be called before OpenCV codes or decodes an image: its first use registers the drivers of GDAL, which print and
/// abort where memory ends. @throws std::bad_alloc if there is no room for them
void prepareImageCodecs();
} // namespace fresco::io
