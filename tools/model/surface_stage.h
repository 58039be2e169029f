// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "model/pipeline.h"
namespace fresco {
/// Surface of the points: reads `files.points`, writes `files.surface`.
nlohmann::ordered_json makeSurface(const ModelFiles& files, const ModelOptions& options, const Progress& progress);
} // namespace fresco
