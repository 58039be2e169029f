// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/text_numbers.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/poses.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/natural_order.h>
#include <fresco/io/rgbd_folder.h>
namespace fresco {
namespace {
namespace fs = std::filesystem;

/// `rows` x `columns` numbers, nothing else; "nan" and "inf" are numbers, too.
Eigen::MatrixXd readMatrix(const std::string& path, int rows, int columns)
{
  const std::string content = readFile(path);
  io::TextScanner words(content);
  Eigen::MatrixXd matrix(rows, columns);
  for (int i = 0; i < rows * columns; ++i)
    try {
      matrix(i / columns, i % columns) = io::parseNumber<double>(words.wordAcrossLines());
    } catch (const std::runtime_error&) {
      throw std::runtime_error(concat(path, ": wants ", rows, "x", columns, " numbers"));
    }
  return matrix;
}

CameraModel depthCamera(const std::string& path, const std::string& depth)
{
  const Eigen::MatrixXd K = readMatrix(path, 3, 3);
  const Image16 first = readImage16(depth);
  CameraModel camera{first.width, first.height, K(0, 0), K(1, 1), K(0, 2) + 0.5, K(1, 2) + 0.5, 0, 0, 0, 0};
  try {
    validateCamera(camera);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  return camera;
}
} // namespace

bool isRgbdFolder(const std::string& folder) { return fs::exists(folder + "/camera-intrinsics.txt"); }

RgbdFolderFiles listRgbdFolder(const std::string& folder)
{
  RgbdFolderFiles result;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    const std::size_t end = file.find(".depth.png");
    if (file.rfind("frame-", 0) != 0 || end == std::string::npos || end + 10 != file.size())
      continue;
    const std::string stem = folder + "/" + file.substr(0, end);
    const auto existing = [&](const char* ending) { return fs::exists(stem + ending) ? stem + ending : ""; };
    RgbdFrameFiles frame{file.substr(0, end), existing(".color.png"), entry.path().string(), existing(".pose.txt")};
    if (frame.color.empty())
      frame.color = stem + ".color.jpg";
    if (!fs::exists(frame.color))
      throw std::runtime_error(frame.color + ": no such file, but " + frame.depth + " is there");
    result.frames.push_back(frame);
  }
  if (result.frames.empty())
    throw std::runtime_error(folder + ": no frame-*.depth.png in it");
  std::sort(result.frames.begin(), result.frames.end(),
            [](const auto& a, const auto& b) { return isNaturallyBefore(a.name, b.name); });
  result.camera = depthCamera(folder + "/camera-intrinsics.txt", result.frames.front().depth);
  return result;
}

std::optional<Eigen::Isometry3d> readRgbdPose(const std::string& path)
{
  const Eigen::Matrix4d T = readMatrix(path, 4, 4);
  if (!T.allFinite())
    return {};
  constexpr double rounded = 0.02; // trackers add up rotations without making them rotations again
  if (!isRigid(T, rounded))
    throw std::runtime_error(path + ": not a rigid transform");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(Eigen::Matrix3d(T.topLeftCorner<3, 3>())).normalized().toRotationMatrix();
  pose.translation() = T.topRightCorner<3, 1>();
  return pose;
}
} // namespace fresco
