// SPDX-License-Identifier: BSD-3-Clause
#include "input/rgbd.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/io/image_io.h>
namespace fresco::model {
namespace {
/// Metres between which depth cameras of structured light and time of flight measure within 2 % of the depth.
constexpr float nearest_depth = 0.3f, farthest_depth = 4.f;

DepthImage depthOf(const Image16& image, const RgbdFolder& folder, const std::string& path, int threads)
{
  if (image.width != folder.camera.width || image.height != folder.camera.height)
    throw std::runtime_error(concat(path, ": ", image.width, "x", image.height, " pixels, but the first frame has ",
                                    folder.camera.width, "x", folder.camera.height));
  DepthImage depth(image.height, image.width);
  parallelFor(depth.size(), threads, [&](Index i) {
    const float z = 1e-3f * image.data[i];
    depth.data()[i] = image.data[i] != 65535 && z >= nearest_depth && z <= farthest_depth ? z : 0.f;
  });
  return depth;
}
} // namespace

RgbdFolder readRgbdFolder(const std::string& folder)
{
  const RgbdFolderFiles files = listRgbdFolder(folder);
  RgbdFolder result;
  result.camera = files.camera;
  result.has_poses =
      std::any_of(files.frames.begin(), files.frames.end(), [](const auto& f) { return !f.pose.empty(); });
  for (const RgbdFrameFiles& file : files.frames) {
    RgbdFrame frame{file.name, file.color, file.depth};
    if (result.has_poses) {
      const auto pose = file.pose.empty() ? std::nullopt : readRgbdPose(file.pose);
      result.without_pose += file.pose.empty();
      if (!pose)
        continue;
      frame.T_world_camera = *pose;
    }
    result.frames.push_back(frame);
  }
  if (result.frames.empty())
    throw std::runtime_error(folder + ": no frame has a finite pose");
  return result;
}

DepthImage readDepth(const RgbdFolder& folder, Index frame)
{
  const std::string& path = folder.frames.at(frame).depth;
  return depthOf(readImage16(path), folder, path, 1);
}

DepthReader::DepthReader(const RgbdFolder& folder, int threads)
    : folder_(folder), threads_(threads), kept_(folder.frames.size())
{}

DepthImage DepthReader::operator()(Index frame)
{
  if (kept_[frame].data.empty())
    readAhead(frame);
  const std::string& path = folder_.frames.at(frame).depth;
  return depthOf(kept_[frame].data.empty() ? readImage16(path) : kept_[frame], folder_, path, threads_);
}

void DepthReader::readAhead(Index frame)
{
  constexpr Index room = 512 << 20, ahead = 16; // bytes of images that are kept: 870 of 640 x 480
  const Index bytes = 2 * Index(folder_.camera.width) * folder_.camera.height;
  const Index count = std::min<Index>({ahead, Index(kept_.size()) - frame, (room - bytes_) / bytes});
  bytes_ += count * bytes;
  parallelFor(
      count, threads_, [&](Index i) { kept_[frame + i] = readImage16(folder_.frames[frame + i].depth); }, 1);
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
