// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples.h"
namespace fresco::poisson {
/// Sets the noise of each sample, judged from how far neighbours along the
/// Z-order curve lie off each other's tangent planes (median over a run of
/// samples, so that edges do not count as noise), and lowers its depth to where
/// the noise of the samples in a cell averages out to a small part of the cell.
/// Needs areas and depths.
void estimateNoise(Samples& samples, int threads);

/// Weight of chi(sample)^2 in the energy per unit of VolumetricOptions::point_weight and of area.
/// @param noise in cells of the depth that is solved
inline float screeningWeight(float noise)
{
  constexpr float gain = 2.5f;      // measured: less leaves ripples of the normal field, more follows every sample
  constexpr float tolerated = 0.2f; // noise at which the weight is halved; far beyond, it falls as 1 / variance
  return gain / (1.f + noise * noise / (tolerated * tolerated));
}
} // namespace fresco::poisson
