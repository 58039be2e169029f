// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
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
  DepthFrame(const CameraModel& camera, DepthImage depth, const Eigen::Isometry3d& T_world_camera);

  /// Over all tiles that the rectangle of pixels touches; empty outside of the image.
  DepthRange range(float left, float top, float right, float bottom) const;

  /// Depth at a pixel (integers = centres): bilinear on a surface, the nearest pixel's beside a jump, 0 = none.
  float depthAt(float u, float v) const;

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
inline float DepthFrame::depthAt(float u, float v) const
{
  constexpr float jump =
      0.02f; // of the depth, between pixels next to each other: steeper than 80 degrees at 600 pixels
  if (!(u >= 0.f && v >= 0.f && u < width - 1 && v < height - 1))
    return 0.f;
  const int iu = static_cast<int>(u), iv = static_cast<int>(v);
  const float fu = u - iu, fv = v - iv;
  const float* upper = &depth(iv, iu);
  const float* lower = upper + width;
  const float nearest = (fv > 0.5f ? lower : upper)[fu > 0.5f];
  const float least = std::min({upper[0], upper[1], lower[0], lower[1]});
  const float greatest = std::max({upper[0], upper[1], lower[0], lower[1]});
  if (least <= 0.f || greatest - least > jump * nearest)
    return nearest;
  return (upper[0] * (1 - fu) + upper[1] * fu) * (1 - fv) + (lower[0] * (1 - fu) + lower[1] * fu) * fv;
}
} // namespace fresco::fusion
