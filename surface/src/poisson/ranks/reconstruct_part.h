// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples/point_shares.h"
namespace fresco::poisson {
/// As reconstructVolumetricPart(), divided as told.
VolumetricPart reconstructPart(std::unique_ptr<PointStream> points, const VolumetricOptions& options,
                               const Progress& progress, const RankOptions& ranks, Exchange& exchange);
} // namespace fresco::poisson
