// SPDX-License-Identifier: BSD-3-Clause
// NVM_V3 of VisualSfM: http://ccwu.me/vsfm/doc.html#nvm, and NVM_V3_R9T of its bundle adjustment. Axes x right, y down, z
// forward; pixels count from the middle of the photograph. Names have " for blanks.
#include "io/cameras/camera_format.h"
#include <algorithm>
namespace fresco::io {
namespace {
/// A measured place m in units of the focal length is undistorted to (1 + d m^2) m; cameras distort. Of the inverse, which is a
/// power series of d r^2, this is the quotient of two cubics with its first seven terms: within 3e-4 pixels at 30 degrees
/// from the axis, f = 1000 and |d| = 0.2.
void distortByMeasurement(CameraModel& camera, double d)
{
  camera.k1 = 113.0 / 13 * d, camera.k2 = 243.0 / 13 * d * d, camera.k3 = 85.0 / 13 * d * d * d;
  camera.k4 = 126.0 / 13 * d, camera.k5 = 330.0 / 13 * d * d, camera.k6 = 193.0 / 13 * d * d * d;
}

Eigen::Matrix4d poseIn(Words& words, bool as_matrix)
{
  if (as_matrix) {
    const Eigen::Matrix3d R = words.matrix();
    return rigid(R, words.vector<3>());
  }
  const Eigen::Vector4d q = words.vector<4>(); // w x y z
  const Eigen::Matrix3d R = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return rigid(R, -(R * words.vector<3>()));
}
} // namespace

bool isNvm(std::string_view head) { return head.rfind("NVM_V3", 0) == 0; }

void readNvm(const std::string& content, CameraFileBuilder& cameras)
{
  Words words{TextScanner(content)};
  const bool as_matrix = words.scanner.word() == "NVM_V3_R9T", fixed = words.scanner.word() == "FixedK";
  const Eigen::Vector4d K = fixed ? words.vector<4>() : Eigen::Vector4d::Zero(); // fx cx fy cy
  words.scanner.nextLine();
  const auto count = words.number<std::size_t>();
  std::vector<int> views;
  for (std::size_t v = 0; v < count; ++v) {
    std::string name(words.scanner.wordAcrossLines());
    std::replace(name.begin(), name.end(), '"', ' ');
    CameraModel camera = cameras.cameraOf(name);
    camera.fx = camera.fy = words.number();
    const Eigen::Matrix4d T = poseIn(words, as_matrix);
    distortByMeasurement(camera, words.number());
    words.number(); // the end of the camera
    if (fixed)
      camera.fx = K[0], camera.cx = K[1], camera.fy = K[2], camera.cy = K[3];
    views.push_back(cameras.addView(name, camera, T));
  }
  const auto points = words.number<std::size_t>();
  addPoints(words, {points, views, 1}, cameras);
}
} // namespace fresco::io
