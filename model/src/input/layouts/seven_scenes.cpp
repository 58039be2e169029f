// SPDX-License-Identifier: BSD-3-Clause
// Shotton et al. 2013, "Scene Coordinate Regression Forests for Camera Relocalization in RGB-D Images"; all in one folder.
#include "input/frame_files.h"
#include <fresco/core/require.h>
#include <fresco/io/rgbd_folder.h>
namespace fresco::model {
RgbdParts readSevenScenes(const Survey& found, ModelInput&)
{
  if (!found.has("camera-intrinsics.txt"))
    throw std::runtime_error(
        found.at("camera-intrinsics.txt") +
        ": no such file: write the 3x3 intrinsics of the depth camera into it (those of 7-Scenes: 585 0 320, "
        "0 585 240, 0 0 1), or copy that of the folder above, if it has one");
  const RgbdFolderFiles files = listRgbdFolder(found.path());
  RgbdParts parts;
  parts.camera_file = found.at("camera-intrinsics.txt");
  parts.folder.camera = files.camera;
  for (const RgbdFrameFiles& file : files.frames) {
    RgbdFrame frame;
    frame.name = file.name, frame.color = file.color, frame.depth = file.depth;
    parts.folder.frames.push_back(frame);
    const auto pose = file.pose.empty() ? std::nullopt : readRgbdPose(file.pose);
    parts.poses.push_back(pose ? Pose(pose->matrix()) : std::nullopt);
  }
  const bool any =
      std::any_of(files.frames.begin(), files.frames.end(), [](const auto& file) { return !file.pose.empty(); });
  if (any && std::none_of(parts.poses.begin(), parts.poses.end(), [](const Pose& pose) { return bool(pose); }))
    throw std::runtime_error(found.path() + ": no frame has a finite pose");
  return parts;
}
} // namespace fresco::model
