// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/image.h>
namespace fresco::io {
/// The bytes of a PNG file. OpenCV's encoder takes 1.4 times as long for files of this size, in one thread
/// (docs/measurements/images.md). Bands of rows are packed side by side; the bytes do not depend on the number of threads.
/// @param image of 1, 3 or 4 channels @param threads 0 = all cores
std::vector<std::uint8_t> encodePng(const Image& image, int threads = 0);
} // namespace fresco::io
