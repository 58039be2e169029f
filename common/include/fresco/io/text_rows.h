// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <fresco/core/export.h>
#include <fresco/core/poses.h>
#include <string>
#include <string_view>
#include <vector>
/// Small text files of numbers and names beside pictures and points: poses, cameras, lists.
namespace fresco {
/// Cells of a row, parted by blanks, tabs, commas, semicolons or bars; a quoted cell is whole. '#' begins a comment.
FRESCO_EXPORT std::vector<std::string> cellsOf(std::string_view row);

/// The rows of a file that have a cell.
FRESCO_EXPORT std::vector<std::vector<std::string>> readTextRows(const std::string& path);

/// "nan" and "inf" are numbers, too. @throws std::runtime_error naming the file if `cell` is none
FRESCO_EXPORT double numberIn(const std::string& path, const std::string& cell);

/// As many numbers and nothing else. @throws std::runtime_error naming the file
FRESCO_EXPORT Eigen::MatrixXd readMatrix(const std::string& path, int rows, int columns);

/// A pose as trackers write them, who add up rotations without making them rotations again: that is done here. Nothing where
/// a number is not finite (lost). @throws std::runtime_error naming the file if it is no rigid transform within 0.02
FRESCO_EXPORT Pose rigidPose(const std::string& path, const Eigen::Matrix4d& T);
} // namespace fresco
