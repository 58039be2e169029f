// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pipeline.h"
namespace fresco::model {
/// Texture from the input's photographs: reads `files.mesh`, writes model.obj, .mtl, .png and model.glb.
nlohmann::ordered_json makeTexture(const ModelInput& input, const ModelFiles& files, const ModelOptions& options,
                                   const Progress& progress);
} // namespace fresco::model
