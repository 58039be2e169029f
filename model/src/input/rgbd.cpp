// SPDX-License-Identifier: BSD-3-Clause
#include "input/rgbd.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/poses.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <map>
#include <sstream>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;

/// Metres between which depth cameras of structured light and time of flight measure within 2 % of the depth.
constexpr float nearest_depth = 0.3f, farthest_depth = 4.f;

/// `rows` x `columns` numbers, nothing else; "nan" and "inf" are numbers, too.
Eigen::MatrixXd readMatrix(const std::string& path, int rows, int columns)
{
  std::istringstream words(readFile(path));
  Eigen::MatrixXd matrix(rows, columns);
  std::string word;
  for (int i = 0; i < rows * columns; ++i) {
    char* end = nullptr;
    if (!(words >> word) || (matrix(i / columns, i % columns) = std::strtod(word.c_str(), &end), *end != '\0'))
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

DepthImage depthOf(const Image16& image, const RgbdFolder& folder, const std::string& path)
{
  if (image.width != folder.camera.width || image.height != folder.camera.height)
    throw std::runtime_error(concat(path, ": ", image.width, "x", image.height, " pixels, but the first frame has ",
                                    folder.camera.width, "x", folder.camera.height));
  DepthImage depth(image.height, image.width);
  for (Index i = 0; i < depth.size(); ++i) {
    const float z = 1e-3f * image.data[i];
    depth.data()[i] = image.data[i] != 65535 && z >= nearest_depth && z <= farthest_depth ? z : 0.f;
  }
  return depth;
}
} // namespace

bool isRgbdFolder(const std::string& folder) { return fs::exists(folder + "/camera-intrinsics.txt"); }

RgbdFolder readRgbdFolder(const std::string& folder)
{
  std::map<std::string, RgbdFrame> frames;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    const std::size_t end = file.find(".depth.png");
    if (file.rfind("frame-", 0) == 0 && end != std::string::npos && end + 10 == file.size())
      frames[file.substr(0, end)].depth = entry.path().string();
  }
  if (frames.empty())
    throw std::runtime_error(folder + ": no frame-*.depth.png in it");
  RgbdFolder result;
  result.camera = depthCamera(folder + "/camera-intrinsics.txt", frames.begin()->second.depth);
  for (auto& [name, frame] : frames) {
    frame.name = name;
    const std::string stem = folder + "/" + name;
    frame.color = fs::exists(stem + ".color.png") ? stem + ".color.png" : stem + ".color.jpg";
    if (!fs::exists(frame.color))
      throw std::runtime_error(frame.color + ": no such file, but " + frame.depth + " is there");
    const Eigen::MatrixXd T = readMatrix(stem + ".pose.txt", 4, 4);
    if (!T.allFinite())
      continue;
    constexpr double rounded = 0.02; // trackers add up rotations without making them rotations again
    if (!isRigid(T, rounded))
      throw std::runtime_error(stem + ".pose.txt: not a rigid transform");
    frame.T_world_camera.linear() =
        Eigen::Quaterniond(Eigen::Matrix3d(T.topLeftCorner<3, 3>())).normalized().toRotationMatrix();
    frame.T_world_camera.translation() = T.topRightCorner<3, 1>();
    result.frames.push_back(frame);
  }
  if (result.frames.empty())
    throw std::runtime_error(folder + ": no frame has a finite pose");
  return result;
}

DepthImage readDepth(const RgbdFolder& folder, Index frame)
{
  const std::string& path = folder.frames.at(frame).depth;
  return depthOf(readImage16(path), folder, path);
}

DepthReader::DepthReader(const RgbdFolder& folder) : folder_(folder), kept_(folder.frames.size()) {}

DepthImage DepthReader::operator()(Index frame)
{
  constexpr Index room = 512 << 20; // bytes of images that are kept: 870 of 640 x 480
  const std::string& path = folder_.frames.at(frame).depth;
  Image16& kept = kept_[frame];
  if (!kept.data.empty())
    return depthOf(kept, folder_, path);
  Image16 image = readImage16(path);
  const DepthImage depth = depthOf(image, folder_, path);
  const Index bytes = 2 * image.data.size();
  if (bytes_ + bytes <= room) {
    bytes_ += bytes;
    kept = std::move(image);
  }
  return depth;
}

double pixelFootprint(const RgbdFolder& folder)
{
  constexpr Index asked = 9; // frames: enough for a median of the distance that a room is seen from
  const Index step = std::max<Index>(1, folder.frames.size() / asked);
  std::vector<float> depths;
  for (std::size_t f = 0; f < folder.frames.size(); f += step) {
    const DepthImage depth = readDepth(folder, f);
    constexpr Index stride = 101; // pixels; no divisor of usual widths, so that no column is met twice as often
    for (Index i = 0; i < depth.size(); i += stride)
      if (depth.data()[i] > 0.f)
        depths.push_back(depth.data()[i]);
  }
  if (depths.empty())
    throw std::runtime_error(folder.frames[0].depth + ": hardly any depth in the frames");
  return median(depths) / folder.camera.fx;
}
} // namespace fresco::model
