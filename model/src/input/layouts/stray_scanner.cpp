// SPDX-License-Identifier: BSD-3-Clause
// https://docs.strayrobots.io/apps/scanner/format.html: depth and confidence of an iPhone, colours as a video.
#include "input/frame_files.h"
#include <fresco/core/require.h>
namespace fresco::model {
namespace {
/// Poses by the number of the frame.
std::map<Index, Pose> posesOf(const std::string& path)
{
  std::map<Index, Pose> poses;
  const auto rows = readTextRows(path);
  for (std::size_t r = 1; r < rows.size(); ++r) { // after the header
    if (rows[r].size() < 9)
      throw std::runtime_error(concat(path, ": line ", r + 1, " has ", rows[r].size(),
                                      " values, wants timestamp, frame, x, y, z, qx, qy, qz, qw"));
    const auto number = [&](int k) { return numberIn(path, rows[r][k]); };
    poses[Index(number(1))] =
        poseOf(path, {number(2), number(3), number(4)}, {number(5), number(6), number(7), number(8)});
  }
  return poses;
}
} // namespace

RgbdParts readStrayScanner(const Survey& found, ModelInput& input)
{
  RgbdParts parts;
  parts.camera_file = found.at("camera_matrix.csv");
  parts.camera_of_color = true;
  parts.folder.camera = readCameraMatrix(parts.camera_file, 3);
  if (found.has("rgb/<pictures>")) {
    parts.folder.frames = pairedFrames(found, "rgb/<pictures>", "depth/<depths>", input);
  } else {
    parts.folder.camera.width = 1920, parts.folder.camera.height = 1440; // of the app's video
    input.video = found.at("rgb.mp4");
    for (const std::string& name : found.match("depth/<depths>")) {
      RgbdFrame frame;
      frame.name = name.substr(6), frame.depth = found.at(name), frame.video_frame = numberOfName(name);
      parts.folder.frames.push_back(frame);
    }
    input.found.push_back("rgb.mp4: their colours");
  }
  const std::string odometry = found.at("odometry.csv");
  const std::map<Index, Pose> poses = posesOf(odometry);
  std::size_t missing = 0;
  for (RgbdFrame& frame : parts.folder.frames) {
    const Index number = numberOfName(frame.depth);
    const auto pose = poses.find(number);
    missing += pose == poses.end();
    parts.poses.push_back(pose == poses.end() ? std::nullopt : pose->second);
    const std::string trust = "confidence/" + frame.depth.substr(frame.depth.rfind('/') + 1);
    if (found.holds(trust))
      frame.confidence = found.at(trust);
  }
  if (2 * missing >= parts.folder.frames.size())
    throw std::runtime_error(concat(odometry, ": poses of ", parts.folder.frames.size() - missing, " of ",
                                    parts.folder.frames.size(), " frames: export the recording again"));
  return parts;
}
} // namespace fresco::model
