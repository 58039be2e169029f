// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/image.h>
#include <string>
namespace fresco::rendering {
/// One line of text, cut to its letters' box: coverage of each pixel, 0..255.
/// @param height of the font, pixels
/// @throws std::runtime_error if the text cannot be drawn
Image textCoverage(const std::string& text, int height);
} // namespace fresco::rendering
