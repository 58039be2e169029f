// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/camera.h>
#include <fresco/core/poses.h>
#include <string>
#include <vector>
namespace fresco::model {
/// Rows of words of a text file, separated by blanks, commas or semicolons; empty lines and those that begin with '#' are
/// left out.
std::vector<std::vector<std::string>> readTable(const std::string& path);

/// "nan" and "inf" are numbers, too. @throws std::runtime_error naming the file if `word` is none
double numberIn(const std::string& path, const std::string& word);

/// All numbers of a file in their order. @throws std::runtime_error naming the file unless there are `count`
std::vector<double> readNumbers(const std::string& path, std::size_t count);

/// World from camera; nothing where a number is not finite (lost tracking).
/// @param rounded by how much the rotation may be none, as the file has few digits
/// @throws std::runtime_error naming the file if it is no rigid transform
Pose rigidPose(const std::string& path, const Eigen::Matrix4d& T);

/// @param q x y z w, not all zero @throws as rigidPose()
Pose poseOf(const std::string& path, const Eigen::Vector3d& t, const Eigen::Vector4d& q);

/// Camera of 3x3 (or 4x4) numbers, pixel centres of the file at whole numbers; without a size.
CameraModel readCameraMatrix(const std::string& path, int side);

/// A camera that looks along -z with y up, as OpenGL, ARKit and most mesh programs have it, as one that looks along z with y
/// down.
Eigen::Matrix4d lookingAhead(const Eigen::Matrix4d& T_world_camera);
} // namespace fresco::model
