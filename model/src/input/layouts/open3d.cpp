// SPDX-License-Identifier: BSD-3-Clause
// Folders of Open3D's reconstruction system: color/, depth/, camera_intrinsic.json, trajectory.log (Choi et al. 2015, "Robust
// Reconstruction of Indoor Scenes"). Those of Redwood are the same without the camera.
#include "input/frame_files.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <map>
#include <nlohmann/json.hpp>
namespace fresco::model {
namespace {
CameraModel cameraOf(const std::string& path)
{
  const nlohmann::json json = nlohmann::json::parse(readFile(path), nullptr, false);
  const auto wrong = [&] {
    return std::runtime_error(
        path + ": wants width, height and intrinsic_matrix, nine numbers by columns, as Open3D writes them");
  };
  try {
    const nlohmann::json& K = json.at("intrinsic_matrix");
    CameraModel camera{json.at("width"), json.at("height")};
    if (K.size() != 9)
      throw wrong();
    camera.fx = K[0], camera.fy = K[4], camera.cx = double(K[6]) + 0.5, camera.cy = double(K[7]) + 0.5;
    return camera;
  } catch (const nlohmann::json::exception&) {
    throw wrong();
  }
}

/// World from camera of each frame: per frame a line of three whole numbers and a 4x4 matrix. The first number is that of the
/// frame, where they are n in a row; else the order of the file counts. None where there is no such file.
/// @param frames how many poses are wanted @throws std::runtime_error naming the file if it has another number or is malformed
std::vector<Pose> readPoseLog(const Survey& found, std::size_t frames)
{
  const std::vector<std::string> names = found.match("trajectory.log|*.log|*-traj.txt");
  if (names.empty())
    return {};
  const std::string path = found.at(names[0]);
  const auto rows = readTextRows(path);
  if (rows.size() % 5 != 0)
    throw std::runtime_error(
        concat(path, ": ", rows.size(), " lines, but each pose has five: three numbers and a 4x4 matrix"));
  if (rows.size() / 5 != frames)
    throw std::runtime_error(concat(path, ": ", rows.size() / 5, " poses for ", frames,
                                    " frames: complete it, or take it away and the frames are tracked"));
  std::map<double, Pose> by_number;
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < rows.size(); k += 5) {
    Eigen::Matrix4d T;
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) {
        if (rows[k + 1 + r].size() != 4)
          throw std::runtime_error(concat(path, ": pose ", k / 5 + 1, " is not 4 lines of 4 numbers"));
        T(r, c) = numberIn(path, rows[k + 1 + r][c]);
      }
    poses.push_back(rigidPose(path, T));
    by_number[numberIn(path, rows[k][0])] = poses.back();
  }
  if (by_number.size() == frames && by_number.rbegin()->first - by_number.begin()->first + 1 == double(frames))
    std::transform(by_number.begin(), by_number.end(), poses.begin(), [](const auto& entry) { return entry.second; });
  return poses;
}
} // namespace

RgbdParts readOpen3d(const Survey& found, ModelInput& input)
{
  RgbdParts parts;
  parts.folder.frames =
      pairedFrames(found, "color/<pictures>|rgb/<pictures>|image/<pictures>", "depth/<depths>", input);
  const std::vector<std::string> intrinsics = found.match("camera_intrinsic.json|intrinsic.json|camera.json");
  parts.camera_file = found.at(intrinsics.empty() ? "camera_intrinsic.json" : intrinsics[0]);
  if (intrinsics.empty()) {
    parts.folder.camera = usualCamera(parts.folder.frames[0].depth, parts.camera_file);
    input.warnings.push_back("no camera_intrinsic.json: the camera is taken as Redwood's, fx = fy = 525");
  } else {
    parts.folder.camera = cameraOf(parts.camera_file);
  }
  parts.poses = readPoseLog(found, parts.folder.frames.size());
  return parts;
}
} // namespace fresco::model
