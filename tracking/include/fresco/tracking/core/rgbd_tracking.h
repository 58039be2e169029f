// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/export.h>
#include <fresco/core/image.h>
#include <fresco/core/poses.h>
#include <fresco/core/progress.h>
#include <fresco/core/types.h>
#include <functional>
#include <string>
#include <vector>
namespace fresco {
/// What an RGB-D camera saw at one moment. The two images may differ in size; they look the same way.
struct RgbdImage {
  Image color;   ///< RGB or grey; empty or black = only the depth is used
  Image16 depth; ///< along the viewing axis, in RgbdVideo::depth_unit; 0 and 65535 = none
};

/// Frames in the order in which they were taken.
struct RgbdVideo {
  CameraModel camera;                         ///< of the depth images, without distortion
  Index count = 0;                            ///< frames
  double depth_unit = 1e-3;                   ///< metres, > 0
  std::function<RgbdImage(Index frame)> read; ///< asked from several threads at once; for some frames twice. A frame
                                              ///< whose reading throws std::runtime_error is lost, with a warning
};

/// Tracking of a hand-held RGB-D camera. Lengths in metres.
struct RgbdTrackingOptions {
  double nearest = 0.3;        ///< depths below are not used, > 0
  double farthest = 5.0;       ///< depths beyond are not used, > nearest: structured light errs by 4 % and more there
  bool calibrate_color = true; ///< find focal length and place of the colour camera; else it is the depth camera
  int refinement_rounds = 2;   ///< alignments of all overlapping key frames, 0..10
  int threads = 0;             ///< 0 = all cores; the result does not depend on it
  std::vector<std::string> names; ///< of the frames, for warnings; empty = their numbers
};

struct RgbdTrackingResult {
  std::vector<Pose> poses;  ///< world from camera, per frame; the first placed frame is the world. Nothing = lost
  std::vector<int> submaps; ///< per frame: 0 = that of `poses`; further ones could not be joined; -1 = lost
  std::vector<Index> key_frames;
  Index loop_closures = 0;  ///< pairs of key frames that are not next to each other and hold the map together
  CameraModel color_camera; ///< pinhole, in pixels of the colour images
  Eigen::Vector3d color_from_depth = Eigen::Vector3d::Zero(); ///< the depth camera's place in the colour camera's frame
  std::vector<std::string> warnings; ///< a line each: frames lost or unreadable, submaps left out
};

/// Poses of an RGB-D video: dense alignment of each frame with a key frame by intensities and depths, a new submap
/// where that fails, loop closures by features, and a joint refinement of all key frames. See docs/tracking.md.
/// @throws std::invalid_argument if there is no frame, the camera has distortion or an option is out of range
/// @throws std::runtime_error if no frame has enough depth, or an image has another size than the first
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT RgbdTrackingResult trackRgbd(const RgbdVideo& video, const RgbdTrackingOptions& options = {},
                                           const Progress& progress = {});
} // namespace fresco
