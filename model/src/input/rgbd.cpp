// SPDX-License-Identifier: BSD-3-Clause
#include "input/rgbd.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/io/image_io.h>
namespace fresco::model {
namespace {
/// Metres between which depth cameras of structured light and time of flight measure within 2 % of the depth.
constexpr float nearest_depth = 0.3f, farthest_depth = 4.f;

DepthImage metresOf(const Image16& image, double unit, int threads)
{
  DepthImage depth(image.height, image.width);
  parallelFor(depth.size(), threads, [&](Index i) {
    const float z = unit * image.data[i];
    depth.data()[i] = image.data[i] != 65535 && z >= nearest_depth && z <= farthest_depth ? z : 0.f;
  });
  return depth;
}

/// Takes away what the device trusts least: the lowest of the levels 0, 1, 2 or 0, 127, 255.
void dropUntrusted(Image16& depth, const std::string& path)
{
  const Image trust = readImage(path);
  if (trust.width != depth.width || trust.height != depth.height)
    throw std::runtime_error(concat(path, ": ", trust.width, "x", trust.height, " pixels, its depth image has ",
                                    depth.width, "x", depth.height));
  for (std::size_t i = 0; i < depth.data.size(); ++i)
    if (*trust.pixel(int(i) % trust.width, int(i) / trust.width) == 0)
      depth.data[i] = 0;
}

/// As another camera at the same place sees it; nearest pixels, so that no depth is invented between two surfaces.
Image16 resampled(const Image16& image, const CameraModel& from, const CameraModel& to)
{
  Image16 out{to.width, to.height, std::vector<std::uint16_t>(std::size_t(to.width) * to.height, 0)};
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x) {
      const double u = (x + 0.5 - to.cx) / to.fx * from.fx + from.cx, v = (y + 0.5 - to.cy) / to.fy * from.fy + from.cy;
      if (u >= 0 && v >= 0 && u < from.width && v < from.height)
        out.data[std::size_t(y) * to.width + x] = image.data[std::size_t(v) * from.width + std::size_t(u)];
    }
  return out;
}

/// @throws std::runtime_error naming a file that does not hold what the first one does
Image16 unitsIn(const std::string& path, bool in_metres)
{
  DepthFile file = readDepthFile(path);
  if (file.in_metres != in_metres)
    throw std::runtime_error(path + (in_metres ? ": whole numbers, but the first frame's depths are floats"
                                               : ": floats, but the first frame's depths are whole numbers"));
  return std::move(file.image);
}

/// @throws std::runtime_error where the depths cannot be ones that a camera measures, in the unit that the layout has
void requirePlausible(const RgbdFolder& folder)
{
  constexpr float least = 0.05f,
                  most = 100; // metres, of a median: what cameras look at, with room for long shots outdoors
  std::vector<float> depths;
  const std::size_t step = std::max<std::size_t>(1, folder.frames.size() / 3);
  for (std::size_t f = 0; f < folder.frames.size(); f += step)
    for (const std::uint16_t value : unitsIn(folder.frames[f].depth, folder.in_metres).data)
      if (value != 0 && value != 65535)
        depths.push_back(folder.depth_unit * value);
  const std::string& path = folder.frames[0].depth;
  if (depths.empty())
    throw std::runtime_error(
        path + ": no depth in it, nor in others (0 and 65535 are none): is the unit so large that all is cut "
               "off? 16 bit want whole millimetres, floats metres");
  if (const float typical = median(depths); !(typical >= least && typical <= most))
    throw std::runtime_error(concat(path, ": a median depth of ", typical,
                                    " m cannot be: this layout counts in units of ", 1000 * folder.depth_unit,
                                    " mm; convert the depth images to that, or say their unit (-depth_unit METRES)"));
}
} // namespace

CameraModel resized(const CameraModel& camera, int width, int height)
{
  const double sx = double(width) / camera.width, sy = double(height) / camera.height;
  require(std::abs(sx / sy - 1) <= 0.02, "an image of ", width, "x", height,
          " pixels is no smaller or larger picture of a camera of ", camera.width, "x", camera.height);
  CameraModel out = camera;
  out.width = width, out.height = height;
  out.fx *= sx, out.cx *= sx, out.fy *= sy, out.cy *= sy;
  return out;
}

RgbdFolder assembleRgbd(RgbdParts parts)
{
  RgbdFolder& folder = parts.folder;
  const RgbdFrame& first = folder.frames.front();
  const ImageSize depth = readImageSize(first.depth);
  ImageSize color;
  if (first.video_frame < 0)
    color = readImageSize(first.color);
  CameraModel& camera = folder.camera;
  try {
    if (camera.width == 0 && color.width == 0 && parts.camera_of_color) // frames of a video: not known yet
      camera.width = std::lround(2 * camera.cx), camera.height = std::lround(2 * camera.cy);
    else if (camera.width == 0 && parts.camera_of_color)
      camera.width = color.width, camera.height = color.height;
    else if (camera.width == 0)
      camera.width = depth.width, camera.height = depth.height;
    validateCamera(camera);
    const CameraModel of_color = color.width == 0 ? camera : resized(camera, color.width, color.height);
    for (RgbdFrame& frame : folder.frames)
      if (frame.color_camera.width == 0)
        frame.color_camera = of_color;
      else {
        validateCamera(frame.color_camera);
        frame.camera = resized(frame.color_camera, depth.width, depth.height);
      }
    camera = resized(camera, depth.width, depth.height);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(
        concat(parts.camera_file, ": does not fit ", first.depth, " or ", first.color, ": ", error.what()));
  }
  folder.in_metres = readDepthFile(first.depth).in_metres;
  if (folder.in_metres)
    folder.depth_unit = metres_unit;
  requirePlausible(folder);
  folder.has_poses = std::any_of(parts.poses.begin(), parts.poses.end(), [](const Pose& pose) { return bool(pose); });
  if (!folder.has_poses)
    return std::move(folder);
  std::vector<RgbdFrame> placed;
  for (std::size_t f = 0; f < folder.frames.size(); ++f)
    if (parts.poses.at(f)) {
      placed.push_back(folder.frames[f]);
      placed.back().T_world_camera = Eigen::Isometry3d(*parts.poses[f]);
    }
  folder.without_pose = folder.frames.size() - placed.size();
  folder.frames = std::move(placed);
  return std::move(folder);
}

Image16 readDepthUnits(const RgbdFolder& folder, Index f)
{
  const RgbdFrame& frame = folder.frames.at(f);
  Image16 image = unitsIn(frame.depth, folder.in_metres);
  const CameraModel& own = frame.camera.width > 0 ? frame.camera : folder.camera;
  if (image.width != own.width || image.height != own.height)
    throw std::runtime_error(concat(frame.depth, ": ", image.width, "x", image.height,
                                    " pixels, but the first frame has ", own.width, "x", own.height));
  if (!frame.confidence.empty())
    dropUntrusted(image, frame.confidence);
  return frame.camera.width > 0 ? resampled(image, frame.camera, folder.camera) : image;
}

DepthImage readDepth(const RgbdFolder& folder, Index frame)
{
  return metresOf(readDepthUnits(folder, frame), folder.depth_unit, 1);
}

DepthReader::DepthReader(const RgbdFolder& folder, int threads)
    : folder_(folder), threads_(threads), kept_(folder.frames.size())
{}

DepthImage DepthReader::operator()(Index frame)
{
  if (kept_[frame].data.empty())
    readAhead(frame);
  return metresOf(kept_[frame].data.empty() ? readDepthUnits(folder_, frame) : kept_[frame], folder_.depth_unit,
                  threads_);
}

void DepthReader::readAhead(Index frame)
{
  constexpr Index room = 512 << 20, ahead = 16; // bytes of images that are kept: 870 of 640 x 480
  const Index bytes = 2 * Index(folder_.camera.width) * folder_.camera.height;
  const Index count = std::min<Index>({ahead, Index(kept_.size()) - frame, (room - bytes_) / bytes});
  bytes_ += count * bytes;
  parallelFor(
      count, threads_, [&](Index i) { kept_[frame + i] = readDepthUnits(folder_, frame + i); }, 1);
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
