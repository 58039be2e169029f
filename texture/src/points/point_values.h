// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "points/surface_samples.h"
#include <fresco/texture/core/point_texture.h>
namespace fresco::texture {
/// 3xM, 0..255: colours, or intensities as grey, of the samples. Brought to one exposure if the options want that: fills
/// gains and exponents of the result.
Points sampleValues(const PointSet& set, const SurfaceSamples& samples, const PointTextureOptions& options,
                    PointTextureResult& result);
} // namespace fresco::texture
