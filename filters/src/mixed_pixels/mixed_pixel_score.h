// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "mixed_pixels/mixed_pixel_candidates.h"
#include <vector>
namespace fresco::filters {
/// Logarithms of the odds that a point lies in the air, as far as scans of generated rooms tell: networks of two layers
/// that benchmark/training/mixed_pixels.py trains.
float veilScore(const VeilFigures& figures);
float veilScore(const LikelyFigures& figures);

/// Scores of all beams by VeilFigures, by position; least_likely for what is no candidate. forLikelyVeil() goes on.
std::vector<float> firstScores(const BeamScan& scan, const VeilOptions& options);
} // namespace fresco::filters
