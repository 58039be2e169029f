// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "alignment_kernels.h"
#include "rgbd_pyramid.h"
namespace fresco::tracking {
/// Points of one resolution of a frame that others are aligned with: where the depth is smooth.
class ReferenceLevel {
public:
  ReferenceLevel() = default;
  ReferenceLevel(const RgbdLevel& level, const RgbdCameras& cameras);

  Index size() const { return size_; } ///< without padding
  Index padded() const { return padded_; }
  ReferenceArrays arrays() const;
  Eigen::Vector3f point(Index i) const { return {row(0)[i], row(1)[i], row(2)[i]}; }
  double median_depth = 0; ///< metres

private:
  static constexpr int rows = 10; // of ReferenceArrays
  float* row(int r) { return data_.data() + r * padded_; }
  const float* row(int r) const { return data_.data() + r * padded_; }
  Index size_ = 0, padded_ = 0;
  Array<float> data_;
};

/// Fine to coarse.
using ReferenceFrame = std::vector<ReferenceLevel>;

ReferenceFrame makeReference(const RgbdPyramid& pyramid, const RgbdCameras& cameras);

/// Standard deviation of a depth of structured light: Nguyen, Izadi, Lovell 2012, metres.
inline float depthDeviation(float z) { return 0.0012f + 0.0019f * (z - 0.4f) * (z - 0.4f); }

/// Plane through the depths around a pixel: 1/z is linear in the pixel. Unit normal away from the camera.
struct SmoothDepth {
  float z = 0; ///< 0 = no smooth surface there
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};
SmoothDepth smoothDepth(const Plane& depth, const Pinhole& camera, int x, int y, int radius);
} // namespace fresco::tracking
