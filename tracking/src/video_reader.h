// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "rgbd_pyramid.h"
#include <string>
namespace fresco::tracking {
/// The frames of a video as pyramids. Frames that cannot be read are pyramids without levels.
class VideoReader {
public:
  /// @throws std::runtime_error if no frame can be read
  VideoReader(const RgbdVideo& video, const RgbdTrackingOptions& options);

  Index count() const { return video_.count; }
  const CameraModel& colorCamera() const { return color_; } ///< as if it were the depth camera

  /// For several threads at once.
  /// @throws std::runtime_error if an image has another size than the first one
  RgbdPyramid operator()(Index frame) const;

  std::string name(Index frame) const;

private:
  const RgbdVideo& video_;
  const RgbdTrackingOptions& options_;
  CameraModel color_;
};
} // namespace fresco::tracking
