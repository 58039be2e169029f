// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "input/model_input.h"
#include "job/files.h"
#include <fresco/core/image.h>
#include <fresco/core/progress.h>
#include <nlohmann/json.hpp>
namespace fresco::model {
/// @throws std::runtime_error with a line that tells what to install, if the program ffmpeg is not there
void requireVideoProgram(const std::string& video);

struct KeptFrames {
  double count = 0, pixels = 0; ///< of each
};

/// How many frames of a video takeVideoFrames() keeps, about; 0 where ffmpeg does not tell its length.
KeptFrames framesToKeep(const std::string& video);

/// Frames of ModelInput::video by the program ffmpeg, as JPEG into `files.video`: all that RGB-D frames name by their number, else
/// the sharpest of each window of time.
nlohmann::ordered_json takeVideoFrames(const ModelInput& input, const ModelFiles& files, int threads,
                                       const Progress& progress);

/// The frames in `folder` become the input's photographs, or the colours of its RGB-D frames.
/// @throws std::runtime_error naming the video if it has fewer frames than there are depth images
void useVideoFrames(ModelInput& input, const std::string& folder);

/// Mean squared difference of neighbouring pixels, of grey levels: of pictures of one thing the one in focus and at rest has most.
double sharpness(const Image& image);
} // namespace fresco::model
