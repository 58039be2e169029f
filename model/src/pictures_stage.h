// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pipeline.h"
namespace fresco::model {
/// The files that makePictures() writes.
std::vector<std::string> pictureFiles(const ModelFiles& files);

/// Pictures of the model from inside and above: reads mesh and model, writes PNG files into `files.snapshots`.
/// @return figures with an array "pictures" of {file, title}
nlohmann::ordered_json makePictures(const ModelInput& input, const ModelFiles& files, const ModelOptions& options,
                                    const Progress& progress);
} // namespace fresco::model
