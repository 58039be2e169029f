// SPDX-License-Identifier: BSD-3-Clause
// Dai et al. 2017, "ScanNet": a .sens file unpacked into color/, depth/, pose/ and intrinsic/.
#include "input/frame_files.h"
#include <fresco/core/require.h>
#include <fresco/io/rgbd_folder.h>
namespace fresco::model {
RgbdParts readScanNet(const Survey& found, ModelInput& input)
{
  RgbdParts parts;
  parts.folder.frames = pairedFrames(found, "color/<pictures>", "depth/<depths>", input);
  const std::string depth_file = "intrinsic/intrinsic_depth.txt", color_file = "intrinsic/intrinsic_color.txt";
  parts.camera_of_color = !found.has(depth_file);
  parts.camera_file = found.at(parts.camera_of_color ? color_file : depth_file);
  if (!found.has(parts.camera_of_color ? color_file : depth_file))
    throw std::runtime_error(parts.camera_file +
                             ": no such file: the intrinsics (4x4) of the depth or colour camera are wanted");
  parts.folder.camera = readCameraMatrix(parts.camera_file, 4);
  std::map<Index, std::string> poses;
  for (const std::string& name : found.match("pose/*.txt"))
    poses[numberOfName(name)] = found.at(name);
  std::size_t missing = 0;
  for (const RgbdFrame& frame : parts.folder.frames) {
    const auto file = poses.find(numberOfName(frame.name));
    missing += file == poses.end();
    const auto pose = file == poses.end() ? std::nullopt : readRgbdPose(file->second);
    parts.poses.push_back(pose ? Pose(pose->matrix()) : std::nullopt);
  }
  if (2 * missing >= parts.folder.frames.size())
    throw std::runtime_error(concat(found.at("pose"), ": poses of ", parts.folder.frames.size() - missing, " of ",
                                    parts.folder.frames.size(),
                                    " frames: complete them, or take the folder away (then add "
                                    "camera_intrinsic.json and the frames are tracked)"));
  return parts;
}
} // namespace fresco::model
