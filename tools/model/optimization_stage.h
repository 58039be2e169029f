// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "model/pipeline.h"
namespace fresco {
/// Surface optimisation: reads `files.surface` and `files.points`, writes `files.mesh`. Without
/// ModelOptions::optimize the surface is taken as it is.
nlohmann::ordered_json makeOptimizedSurface(const ModelFiles& files, const ModelOptions& options,
                                            const Progress& progress);
} // namespace fresco
