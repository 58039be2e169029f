// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples.h"
namespace fresco::poisson {
/// Sets the noise of each sample, judged from how far neighbours along the Z-order curve lie off each other's tangent
/// planes: the median over a run of samples, so that edges do not count as noise. Lowers the sample's depth to where
/// the noise of the samples in a cell averages out to a small part of the cell. Needs areas and depths.
void estimateNoise(Samples& samples, int threads);
} // namespace fresco::poisson
