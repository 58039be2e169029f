// SPDX-License-Identifier: BSD-3-Clause
#include "video_reader.h"
#include <fresco/core/require.h>
namespace fresco::tracking {
VideoReader::VideoReader(const RgbdVideo& video, const RgbdTrackingOptions& options)
    : video_(video), options_(options), color_(video.camera)
{
  std::string problem;
  for (Index f = 0; f < video.count; ++f)
    try {
      const Image color = video.read(f).color;
      if (!color.empty()) {
        const double scale = double(color.width) / video.camera.width;
        color_.width = color.width, color_.height = color.height;
        color_.fx *= scale, color_.fy *= scale, color_.cx *= scale, color_.cy *= scale;
      }
      return;
    } catch (const std::runtime_error& error) {
      if (problem.empty())
        problem = error.what();
    }
  throw std::runtime_error(problem + "; no frame can be read");
}

std::string VideoReader::name(Index frame) const
{
  return options_.names.empty() ? concat("frame ", frame) : options_.names[frame];
}

RgbdPyramid VideoReader::operator()(Index frame) const
{
  RgbdImage image;
  try {
    image = video_.read(frame);
  } catch (const std::runtime_error& error) {
    RgbdPyramid none;
    none.problem = error.what();
    return none;
  }
  const auto check = [&](const char* what, int width, int height, const CameraModel& camera) {
    if (width != camera.width || height != camera.height)
      throw std::runtime_error(concat(name(frame), ": its ", what, " image has ", width, "x", height,
                                      " pixels, that of the first frame ", camera.width, "x", camera.height,
                                      "; two videos in one folder?"));
  };
  check("depth", image.depth.width, image.depth.height, video_.camera);
  if (!image.color.empty())
    check("colour", image.color.width, image.color.height, color_);
  return makePyramid(image, {video_.depth_unit, options_.nearest, options_.farthest});
}
} // namespace fresco::tracking
