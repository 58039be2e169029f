// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/image.h>
#include <fresco/io/rgbd_folder.h>
#include <fresco/surface/core/depth_fusion.h>
#include <string>
#include <vector>
namespace fresco::model {
struct RgbdFrame {
  std::string name;         ///< "frame-000010"
  std::string color, depth; ///< files
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

struct RgbdFolder {
  CameraModel camera; ///< of the depth images; pixel centres at +0.5
  std::vector<RgbdFrame> frames;
  bool has_poses = true;  ///< else no frame has one: they are to be tracked
  Index without_pose = 0; ///< frames that were left out since they have no file of a pose, but others do
};

/// listRgbdFolder() with the poses of the frames. Frames whose pose is not finite (lost tracking) are left out.
/// @throws std::runtime_error naming the file that is missing or malformed
RgbdFolder readRgbdFolder(const std::string& folder);

/// Metres; 0 = none. Depths farther than such cameras measure well are left out.
/// @throws std::runtime_error naming the file if it is damaged or has another size than the first frame's
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
