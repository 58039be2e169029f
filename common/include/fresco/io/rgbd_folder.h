// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/export.h>
#include <optional>
#include <string>
#include <vector>
namespace fresco {
/// Files of one frame of an RGB-D video.
struct RgbdFrameFiles {
  std::string name;         ///< "frame-000010"
  std::string color, depth; ///< paths
  std::string pose;         ///< path; "" if there is none
};

/// Folder of an RGB-D video.
struct RgbdFolderFiles {
  CameraModel camera;                 ///< of the depth images; pixel centres at +0.5
  std::vector<RgbdFrameFiles> frames; ///< in the order of their numbers
};

/// Whether `camera-intrinsics.txt` lies in the folder.
FRESCO_EXPORT bool isRgbdFolder(const std::string& folder);

/// Lists `camera-intrinsics.txt` (3x3) and of each frame N `frame-N.color.jpg` (or `.png`), `frame-N.depth.png` and
/// `frame-N.pose.txt`. Numbers within names are compared as numbers: frame-9 comes before frame-10. Of the images only the
/// size of the first is looked at.
/// @throws std::runtime_error naming the file that is missing or malformed
FRESCO_EXPORT RgbdFolderFiles listRgbdFolder(const std::string& folder);

/// World from camera, of a file of 4x4 numbers; nothing where they are not finite (lost tracking).
/// @throws std::runtime_error naming the file if it is malformed or holds no rigid transform
FRESCO_EXPORT std::optional<Eigen::Isometry3d> readRgbdPose(const std::string& path);
} // namespace fresco
