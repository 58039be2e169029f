// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "veil_figures.h"
namespace fresco {
/// Logarithms of the odds that a point lies in the air, as far as scans of generated rooms tell: networks of two layers
/// that benchmark/veil_network.py trains.
float veilScore(const VeilFigures& figures);
float veilScore(const LikelyFigures& figures);
} // namespace fresco
