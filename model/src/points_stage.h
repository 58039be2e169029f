// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pipeline.h"
namespace fresco::model {
/// All scans or frames in one frame with normals: reads the input, writes `files.points` and `files.poses`.
nlohmann::ordered_json makePoints(const ModelInput& input, const ModelFiles& files, const ModelOptions& options,
                                  const Progress& progress);
} // namespace fresco::model
