// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/isosurface/isosurface.h"
#include "poisson/samples/samples.h"
namespace fresco::poisson {
struct AttributedSamples {
  const SampleLevel& level;
  const Array<Attributes>& attributes;
};

/// Colour and intensity of each vertex: mean of the samples within a cell, weighted by distance. Where there are none,
/// within a cell of the finest coarser depth that has some.
/// @param samples of the finest depth
/// @return 4xV, colour 0..255 and intensity
Eigen::Matrix4Xf vertexAttributes(const Octree& tree, const AttributedSamples& samples, const IsoSurface& surface,
                                  int threads);
} // namespace fresco::poisson
