// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "input/layout.h"
#include <fresco/io/text_rows.h>
#include <map>
#include <string>
namespace fresco::model {
/// Number that a name begins with ("0000001-000033.png", "depth/17.png") or ends with; -1 = none.
Index numberOfName(const std::string& name);

/// Frames of the files of two folders: depth images and the colour images of the same name, or else of the same number. What
/// has no partner is left out, with a warning in `input`.
/// @param color, depth patterns of Survey::match()
/// @throws std::runtime_error if fewer than half have a partner
std::vector<RgbdFrame> pairedFrames(const Survey& found, const std::string& color, const std::string& depth,
                                    ModelInput& input);

/// Puts the frames together and tells of them. @param depth_unit metres; 0 = that of the layout
void takeFrames(ModelInput& input, RgbdParts parts, double depth_unit);

/// World from camera; nothing where a number is not finite. @param q x y z w, not all zero @throws as rigidPose()
Pose poseOf(const std::string& path, const Eigen::Vector3d& t, const Eigen::Vector4d& q);

/// Camera of 3x3 (or 4x4) numbers, pixel centres of the file at whole numbers; without a size.
CameraModel readCameraMatrix(const std::string& path, int side);

/// A camera that looks along -z with y up, as OpenGL, ARKit and most mesh programs have it, as one that looks along z with y
/// down.
Eigen::Matrix4d lookingAhead(const Eigen::Matrix4d& T_world_camera);

/// Depth cameras of structured light whose layouts say nothing of the camera: fx = fy = 525 at 640x480, as the makers of the
/// layouts recommend. @throws std::runtime_error naming `wanted` if the images have another size
CameraModel usualCamera(const std::string& depth, const std::string& wanted);
} // namespace fresco::model
