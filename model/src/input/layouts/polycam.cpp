// SPDX-License-Identifier: BSD-3-Clause
// Raw data of Polycam, https://github.com/PolyCam/polyform: keyframes/{images,cameras,depth,confidence}, cameras as JSON.
#include "input/frame_files.h"
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <nlohmann/json.hpp>
namespace fresco::model {
namespace {
/// Sets camera and confidence of a frame. @return its pose
Pose readCameraFile(const std::string& path, RgbdFrame& frame)
{
  const nlohmann::json json = nlohmann::json::parse(readFile(path), nullptr, false);
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  try {
    frame.color_camera = {json.at("width"), json.at("height"), json.at("fx"),
                          json.at("fy"),    json.at("cx"),     json.at("cy")};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c)
        T(r, c) = json.at(concat("t_", r, c));
    validateCamera(frame.color_camera);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error(path + ": wants width, height, fx, fy, cx, cy and t_00 to t_23 as numbers");
  }
  Eigen::Matrix4d upright = Eigen::Matrix4d::Identity(); // ARKit's y is up; the world of a model has z up
  upright.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return rigidPose(path, upright * lookingAhead(T));
}
} // namespace

RgbdParts readPolycam(const Survey& found, ModelInput& input)
{
  const bool corrected = found.has("keyframes/corrected_images/") && found.has("keyframes/corrected_cameras/");
  const std::string images = corrected ? "keyframes/corrected_images" : "keyframes/images",
                    cameras = corrected ? "keyframes/corrected_cameras" : "keyframes/cameras";
  RgbdParts parts;
  parts.camera_file = found.at(cameras);
  parts.folder.frames = pairedFrames(found, images + "/<pictures>", "keyframes/depth/<depths>", input);
  for (RgbdFrame& frame : parts.folder.frames) {
    const std::string file = cameras + "/" + frame.name + ".json",
                      trust = "keyframes/confidence/" + frame.name + ".png";
    if (!found.holds(file))
      throw std::runtime_error(found.at(file) +
                               ": no such file, but its depth image is there: export the raw data again");
    parts.poses.push_back(readCameraFile(found.at(file), frame));
    if (found.holds(trust))
      frame.confidence = found.at(trust);
  }
  parts.folder.camera = parts.folder.frames[0].color_camera;
  parts.camera_of_color = true;
  input.found.push_back(cameras + ": a camera and pose per frame");
  return parts;
}
} // namespace fresco::model
