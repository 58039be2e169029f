// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples/samples.h"
namespace fresco::poisson {
/// Sets the noise of each sample, judged from how far neighbours along the Z-order curve lie off each other's tangent
/// planes: the median over close pairs of a run of samples, less what distant pairs lie off beyond it. So neither edges
/// nor shape count as noise. Lowers the sample's depth to where the noise of the samples in a cell averages out to the
/// size of the cell. Needs areas and depths.
/// @param samples of this rank; the curve runs through those of all
void estimateNoise(Samples& samples, Exchange& exchange, int threads);
} // namespace fresco::poisson
