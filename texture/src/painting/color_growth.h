// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
#include <fresco/core/image.h>
namespace fresco::texture {
/// Texels of a part of an atlas whose colours continue those around them.
struct ColorGrowth {
  enum State : std::uint8_t { open, known, left_alone, listed }; ///< listed: open, and in the next front
  Eigen::Vector2i low;                                           ///< upper left texel of the part
  int width;                                                     ///< of the part
  bool diagonal;                    ///< whether all 8 texels around one are its neighbours, not only 4
  int rounds;                       ///< at most
  std::vector<std::uint8_t> states; ///< row by row
};

/// Round by round, each open texel with known neighbours becomes their mean; then it is known.
void growColors(ColorGrowth growth, Image& atlas);

/// Texels between charts take the colours of the charts next to them, 8 texels far: what programs that draw the model
/// from far away mix into a chart's border is then no foreign colour.
void fillGaps(const std::vector<Chart>& charts, int threads, std::vector<Image>& atlases);
} // namespace fresco::texture
