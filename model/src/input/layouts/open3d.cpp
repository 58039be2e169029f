// SPDX-License-Identifier: BSD-3-Clause
// Folders of Open3D's reconstruction system: color/, depth/, camera_intrinsic.json, trajectory.log (Choi et al. 2015).
#include "input/frame_files.h"
#include "input/pose_log.h"
#include <fresco/core/require.h>
#include <fresco/io/file.h>
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
} // namespace

ModelInput readOpen3d(const Survey& found, std::optional<Reading>)
{
  ModelInput input;
  input.folder = found.path();
  RgbdParts parts;
  parts.folder.frames =
      pairedFrames(found, "color/<pictures>|image/<pictures>|rgb/<pictures>", "depth/<pictures>", input);
  parts.camera_file = found.at(found.match("camera_intrinsic.json|intrinsic.json|camera.json")[0]);
  parts.folder.camera = cameraOf(parts.camera_file);
  parts.poses = readPoseLog(found, "trajectory.log|*.log|*-traj.txt", parts.folder.frames.size());
  return rgbdInput(std::move(parts), std::move(input));
}

ModelInput readRedwood(const Survey& found, std::optional<Reading>)
{
  ModelInput input;
  input.folder = found.path();
  RgbdParts parts;
  parts.folder.frames =
      pairedFrames(found, "rgb/<pictures>|image/<pictures>|color/<pictures>", "depth/<pictures>", input);
  parts.camera_file = found.at("camera_intrinsic.json");
  parts.folder.camera = usualCamera(parts.folder.frames[0].depth, parts.camera_file);
  input.warnings.push_back("no camera_intrinsic.json: the camera is taken as Redwood's, fx = fy = 525");
  parts.poses = readPoseLog(found, "*.log|*-traj.txt", parts.folder.frames.size());
  return rgbdInput(std::move(parts), std::move(input));
}
} // namespace fresco::model
