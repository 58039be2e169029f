// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/image.h>
#include <fresco/core/poses.h>
#include <string>
#include <vector>
namespace fresco::model {
struct RgbdFrame {
  std::string name;         ///< "frame-000010"
  std::string color, depth; ///< files; of a video the number of the frame stands in `video_frame`
  std::string confidence;   ///< file of 8 bit per pixel of `depth`, the least trusted ones lowest; "" = none
  Index video_frame = -1;
  CameraModel color_camera; ///< of the size of the colour image
  CameraModel camera;       ///< of the depth image where it differs from RgbdFolder::camera; else of no size
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

struct RgbdFolder {
  CameraModel camera; ///< of the depth images; pixel centres at +0.5
  std::vector<RgbdFrame> frames;
  double depth_unit = 1e-3; ///< metres
  bool in_metres = false;   ///< the files hold metres as floats
  bool has_poses = true;    ///< else no frame has one: they are to be tracked
  Index without_pose = 0;   ///< frames that were left out since they have no pose, but others do
};

/// What a layout tells, before sizes, units and poses are put together.
struct RgbdParts {
  RgbdFolder folder;
  std::vector<Pose> poses; ///< one a frame; empty = none is known
  std::string camera_file; ///< names the camera in messages
  bool camera_of_color =
      false; ///< RgbdFolder::camera is that of the colour images. Without a size it has that of its images
};

/// Frames that are ready for use: cameras of the images' sizes, frames without a pose left out where others have one.
/// @throws std::runtime_error naming the file whose size, depths or intrinsics cannot be, and the cure
RgbdFolder assembleRgbd(RgbdParts parts);

/// The camera of the same picture in another size. @throws std::invalid_argument if the shapes differ by more than 2 %
CameraModel resized(const CameraModel& camera, int width, int height);

/// Depths in RgbdFolder::depth_unit as RgbdFolder::camera sees them; 0 and 65535 = none, which pixels of least confidence become.
/// @throws std::runtime_error naming the file if it is damaged or has another size than the first frame's
Image16 readDepthUnits(const RgbdFolder& folder, Index frame);

/// Metres; 0 = none. Depths farther than such cameras measure well are left out.
/// @throws as readDepthUnits()
DepthImage readDepth(const RgbdFolder& folder, Index frame);

/// The same for frames that are asked for several times in their order: decoded images are kept while there is room.
class DepthReader {
public:
  DepthReader(const RgbdFolder& folder, int threads);
  DepthImage operator()(Index frame);

private:
  /// Keeps this frame and those after it.
  void readAhead(Index frame);

  const RgbdFolder& folder_;
  int threads_;
  std::vector<Image16> kept_; ///< by frame; empty where not kept
  Index bytes_ = 0;
};

/// Side of the patch that a pixel sees at the median depth of all frames, metres.
/// @throws std::runtime_error if no frame has any depth
double pixelFootprint(const RgbdFolder& folder);
} // namespace fresco::model
