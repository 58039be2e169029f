// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <fresco/core/image.h>
#include <string>
#include <vector>
namespace fresco::rendering {
/// Vertical bar of the error colours with ticks: 0 (red) at the bottom, `largest` (blue) at the top.
struct ScaleBar {
  double largest = 1;             ///< > 0
  bool open_ended = false;        ///< larger values occur and look like `largest`
  std::vector<std::string> title; ///< lines above the bar
  std::array<std::uint8_t, 3> text_color{0, 0, 0};
};

/// Pixels that the bar needs at the right side of a picture of that height, with the letters of its title and ticks.
int scaleBarWidth(const ScaleBar& bar, int height);

/// Draws into the strip of scaleBarWidth() at the right side of `image` (RGB or RGBA; what is drawn becomes opaque).
void drawScaleBar(Image& image, const ScaleBar& bar);

/// 0, step, 2 step .. up to `largest`, with a step of 1, 2 or 5 times a power of ten that makes 4 to 11 of them.
std::vector<double> roundTicks(double largest);
} // namespace fresco::rendering
