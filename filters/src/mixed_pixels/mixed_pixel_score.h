// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "mixed_pixels/mixed_pixel_candidates.h"
#include <vector>
namespace fresco::filters {
/// Logarithm of the odds that a point is a mixed pixel: networks with two hidden layers, trained by
/// scans of generated rooms (docs/mixed_pixels.md).
float mixedPixelScore(const MixedPixelFeatures& features);
float mixedPixelScore(const SecondStageFeatures& features);

/// Scores of all beams by MixedPixelFeatures, by position; least_second_stage for what is no candidate.
std::vector<float> firstStageScores(const BeamScan& scan, const MixedPixelOptions& options);
} // namespace fresco::filters
