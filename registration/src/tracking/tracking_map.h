// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tracking/dense_alignment.h"
#include "tracking/image_features.h"
#include <optional>
namespace fresco::tracking {
using registration::IsometryVector;

struct KeyFrame {
  Index frame = 0; ///< number in the video
  RgbdPyramid pyramid;
  ImageFeatures features;
};

/// Two key frames and their measured relative pose.
struct KeyFrameEdge {
  Index a = 0, b = 0; ///< a < b
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity(); ///< as DenseAlignment::information, about a
  double weight = 1;
  double rms = 0;
};

/// Where a frame was tracked.
struct FramePlace {
  Index key_frame = -1; ///< -1 = lost
  Eigen::Isometry3d T_key_frame = Eigen::Isometry3d::Identity();
};

struct TrackingMap {
  RgbdCameras cameras;
  std::vector<KeyFrame> key_frames;
  std::vector<KeyFrameEdge, Eigen::aligned_allocator<KeyFrameEdge>> edges;
  std::vector<FramePlace, Eigen::aligned_allocator<FramePlace>> frames;
};
} // namespace fresco::tracking
