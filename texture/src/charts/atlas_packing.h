// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
namespace fresco::texture {
struct Packing {
  int atlases = 0;
  int side = 0;    ///< texels
  double used = 0; ///< share of texels that have an owner
};

/// Gives each chart its place by its outline, not its box: small ones go into the gaps of large ones. Every chart must
/// fit.
/// One atlas as small as possible, or as few as possible of equal size.
/// @param largest texels, side of an atlas
Packing packCharts(std::vector<Chart>& charts, int largest);
} // namespace fresco::texture
