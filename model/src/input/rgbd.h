// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/image.h>
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
};

/// Whether `camera-intrinsics.txt` lies in the folder.
bool isRgbdFolder(const std::string& folder);

/// `camera-intrinsics.txt` (3x3) and `frame-*.{color.jpg or color.png, depth.png, pose.txt}` (4x4, world from camera).
/// Frames whose pose is not finite (lost tracking) are left out.
/// @throws std::runtime_error naming the file that is missing or malformed
RgbdFolder readRgbdFolder(const std::string& folder);

/// Metres; 0 = none. Depths farther than such cameras measure well are left out.
/// @throws std::runtime_error naming the file if it is damaged or has another size than the first frame's
DepthImage readDepth(const RgbdFolder& folder, Index frame);

/// The same for frames that are asked for several times: decoded images are kept while there is room.
class DepthReader {
public:
  explicit DepthReader(const RgbdFolder& folder);
  DepthImage operator()(Index frame);

private:
  const RgbdFolder& folder_;
  std::vector<Image16> kept_; ///< by frame; empty where not kept
  Index bytes_ = 0;
};

/// Side of the patch that a pixel sees at the median depth of all frames, metres.
/// @throws std::runtime_error if no frame has any depth
double pixelFootprint(const RgbdFolder& folder);
} // namespace fresco::model
