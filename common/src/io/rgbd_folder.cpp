// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/remarks.h"
#include <algorithm>
#include <filesystem>
#include <fresco/io/image_io.h>
#include <fresco/io/natural_order.h>
#include <fresco/io/rgbd_folder.h>
#include <fresco/io/text_rows.h>
namespace fresco {
namespace {
namespace fs = std::filesystem;

CameraModel depthCamera(const std::string& path, const std::string& depth)
{
  const Eigen::MatrixXd K = readMatrix(path, 3, 3);
  const ImageSize first = readImageSize(depth);
  CameraModel camera{first.width, first.height, K(0, 0), K(1, 1), K(0, 2) + 0.5, K(1, 2) + 0.5, 0, 0, 0, 0};
  io::namingFile(path, [&] { validateCamera(camera); });
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
    expect(fs::exists(frame.color), frame.color, ": no such file, but ", frame.depth, " is there");
    result.frames.push_back(frame);
  }
  expect(!result.frames.empty(), folder, ": no frame-*.depth.png in it");
  std::sort(result.frames.begin(), result.frames.end(),
            [](const auto& a, const auto& b) { return isNaturallyBefore(a.name, b.name); });
  result.camera = depthCamera(folder + "/camera-intrinsics.txt", result.frames.front().depth);
  return result;
}

std::optional<Eigen::Isometry3d> readRgbdPose(const std::string& path)
{
  const Pose pose = rigidPose(path, readMatrix(path, 4, 4));
  return pose ? std::optional<Eigen::Isometry3d>(*pose) : std::nullopt;
}
} // namespace fresco
