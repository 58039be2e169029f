// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
#include <fresco/core/image.h>
namespace fresco::texture {
/// Texels between charts take the colours of the charts next to them, 8 texels far: what programs that draw the model
/// from far away mix into a chart's border is then no foreign colour.
void fillGaps(const std::vector<Chart>& charts, int threads, std::vector<Image>& atlases);
} // namespace fresco::texture
