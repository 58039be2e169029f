// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fusion/vote_kernels.h"
#include <fresco/surface/core/depth_fusion.h>
#include <limits>
namespace fresco::fusion {
/// Least and greatest depth within a rectangle of pixels. Where a pixel has none `least` is 0; where all have none
/// `greatest` is 0, too.
struct DepthRange {
  float least = std::numeric_limits<float>::max(), greatest = 0.f;
};

/// A depth image with what is asked of it while it is fused.
class DepthFrame {
public:
  DepthFrame(const CameraModel& camera, DepthImage depth, const Eigen::Isometry3d& T_world_camera, int threads);

  /// Over all tiles that the rectangle of pixels touches; empty outside of the image.
  DepthRange range(float left, float top, float right, float bottom) const;

  DepthPixels pixels() const { return {depth.data(), width, height, fx, fy, cx, cy}; }

  /// Direction with z = 1 that a pixel looks along, in the world.
  Eigen::Vector3f beam(int u, int v) const
  {
    return R_world_camera * Eigen::Vector3f((u - cx) / fx, (v - cy) / fy, 1.f);
  }

  int width, height;
  float fx, fy, cx, cy; ///< pixel centres at integers
  DepthImage depth;
  Eigen::Matrix3f R_world_camera;
  Eigen::Vector3f center;

private:
  int tile_columns_, tile_rows_;
  std::vector<DepthRange> tiles_;
};
} // namespace fresco::fusion
