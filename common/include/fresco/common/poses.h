// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>
namespace fresco {
/// 4x4, world from scan; nothing for a scan that could not be placed.
using Pose = std::optional<Eigen::Matrix4d>;

/// One scan a line: 16 numbers, row-major, or the word `none`. '#' starts a comment, empty lines are skipped.
/// @throws std::runtime_error "PATH: reason" unless every matrix is finite and rigid (within 1e-3)
std::vector<Pose> readPoses(const std::string& path);

void writePoses(const std::string& path, const std::vector<Pose>& poses);
} // namespace fresco
