// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pipeline.h"
namespace fresco::model {
/// Surface of the points: reads `files.points`, writes `files.surface`. Unless it is to be closed, the surface in
/// places that scans or frames saw through is left out.
nlohmann::ordered_json makeSurface(const ModelInput& input, const ModelFiles& files, const ModelOptions& options,
                                   const Progress& progress);
} // namespace fresco::model
