// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/poses.h>
#include <string>
#include <vector>
namespace fresco {
/// One scan a line: 16 numbers, row-major, or the word `none`. '#' starts a comment, empty lines are skipped.
/// @throws std::runtime_error "PATH: reason" unless every matrix is finite and rigid (within 1e-3)
FRESCO_EXPORT std::vector<Pose> readPoses(const std::string& path);

/// The one matrix of a file.
/// @throws std::runtime_error as readPoses(), and if it is not one
FRESCO_EXPORT Eigen::Matrix4d readTransform(const std::string& path);

/// What readPoses() reads; whole or not at all.
/// @throws std::runtime_error "PATH: reason" if it cannot be written
FRESCO_EXPORT void writePoses(const std::string& path, const std::vector<Pose>& poses);
} // namespace fresco
