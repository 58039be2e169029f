// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/isosurface/isosurface.h"
namespace fresco::poisson {
/// Removes the connected components that are too small to be more than a ripple of chi around single samples: of fewer
/// faces than a ball four cells across, and far smaller than the largest component. Ranges and vertex order are kept.
void removeSmallComponents(IsoSurface& surface, int threads);
} // namespace fresco::poisson
