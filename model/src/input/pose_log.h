// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "input/survey.h"
#include <fresco/core/poses.h>
#include <vector>
namespace fresco::model {
/// World from camera of each frame, of a file of Choi et al. 2015, "Robust Reconstruction of Indoor Scenes": per frame a line
/// of three whole numbers and a 4x4 matrix. None where there is no such file.
/// @param frames how many poses are wanted @throws std::runtime_error naming the file if it has another number or is malformed
std::vector<Pose> readPoseLog(const Survey& found, const std::string& pattern, std::size_t frames);
} // namespace fresco::model
