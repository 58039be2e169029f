// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "stages/stages.h"
#include <fresco/texture/core/texture_reconstruction.h>
namespace fresco::model {
/// Some photographs as the viewer of the report shows them: small, level, without distortion, written to `files.places`.
/// @return an array of {name, eye, look, angle, aspect, file}; file relative to the folder of the job
Figures writePhotographPlaces(const Job& job, const std::vector<TextureView>& views);
} // namespace fresco::model
