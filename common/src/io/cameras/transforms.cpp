// SPDX-License-Identifier: BSD-3-Clause
// transforms.json of NeRF, instant-ngp and nerfstudio: https://docs.nerf.studio/quickstart/data_conventions.html. World from
// camera, whose axes are OpenGL's; pixels as in COLMAP, of which their programs take them; coefficients as in OpenCV, k4 of r^8. What
// a frame does not tell holds for all.
#include "io/cameras/camera_format.h"
#include "io/cameras/json_values.h"
#include <algorithm>
#include <cmath>
namespace fresco::io {
namespace {
/// What a frame says of its camera, else the file.
class Said {
public:
  Said(const Json& frame, const Json& all) : frame_(frame), all_(all) {}

  const Json* find(const char* key) const
  {
    return frame_.contains(key) ? &frame_[key] : all_.contains(key) ? &all_[key] : nullptr;
  }
  double number(const char* key, double otherwise = 0) const
  {
    const Json* const found = find(key);
    return found ? numbersOf<1>(*found, key)[0] : otherwise;
  }
  bool isTrue(const char* key) const
  {
    const Json* const found = find(key);
    return found && found->is_boolean() && *found;
  }

private:
  const Json &frame_, &all_;
};

CameraModel cameraIn(const Said& said, const std::string& name, const CameraFileBuilder& cameras)
{
  const std::string model = said.find("camera_model") ? stringOf(*said.find("camera_model"), "camera_model") : "OPENCV";
  CameraModel camera = said.find("w") && said.find("h")
                           ? CameraModel{int(wholeOf(*said.find("w"), "w")), int(wholeOf(*said.find("h"), "h"))}
                           : cameras.cameraOf(name);
  if (model == "EQUIRECTANGULAR" && camera.width == 2 * camera.height && camera.height > 0)
    return sphericalCamera(camera.width, camera.height);
  const bool fisheye = model == "OPENCV_FISHEYE" || said.isTrue("is_fisheye");
  expect(fisheye || model == "OPENCV" || model == "PINHOLE" || model == "SIMPLE_PINHOLE" || model == "PERSPECTIVE",
         "camera_model ", model, " is none of PINHOLE, OPENCV, OPENCV_FISHEYE, EQUIRECTANGULAR");
  const auto focal = [&](const char* key, const char* angle, int side, double otherwise) {
    return said.find(key)     ? said.number(key)
           : said.find(angle) ? 0.5 * side / std::tan(0.5 * said.number(angle))
                              : otherwise;
  };
  camera.fx = focal("fl_x", "camera_angle_x", camera.width, 0);
  camera.fy = focal("fl_y", "camera_angle_y", camera.height, camera.fx);
  expect(camera.fx != 0, "frame ", name, " has neither fl_x nor camera_angle_x: write it again");
  camera.cx = said.number("cx", 0.5 * camera.width), camera.cy = said.number("cy", 0.5 * camera.height);
  camera.k1 = said.number("k1"), camera.k2 = said.number("k2"), camera.k3 = said.number("k3");
  camera.p1 = said.number("p1"), camera.p2 = said.number("p2");
  (fisheye ? camera.k4 : camera.r8) = said.number("k4");
  camera.projection = fisheye ? CameraProjection::fisheye : CameraProjection::perspective;
  return camera;
}
} // namespace

bool isTransforms(std::string_view head)
{
  const char* const keys[] = {"\"transform_matrix\"", "\"camera_angle_x\"", "\"fl_x\""};
  return std::any_of(std::begin(keys), std::end(keys), [&](const char* key) { return head.find(key) != head.npos; });
}

void readTransforms(const std::string& content, CameraFileBuilder& cameras)
{
  const Json json = parsedJson(content);
  for (const Json& frame : memberOf(json, "frames", "it")) {
    const std::string name = stringOf(memberOf(frame, "file_path", "a frame"), "file_path");
    const auto numbers = numbersOf<16>(memberOf(frame, "transform_matrix", "frame " + name), "transform_matrix");
    const Eigen::Matrix4d T = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>(numbers.data());
    expect(isRigid(T, 0.02), "frame ", name, ": its transform_matrix is not rigid");
    cameras.addView(name, cameraIn(Said(frame, json), name, cameras), withTurnedAxes(T.inverse()));
  }
}
} // namespace fresco::io
