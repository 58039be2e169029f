// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "rgbd_pyramid.h"
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::tracking {
/// Corners of an image that have a depth, with their surroundings as binary strings (ORB: Rublee et al. 2011).
struct ImageFeatures {
  static constexpr int bytes = 32;
  registration::OrientedPoints places;   ///< points and normals towards the camera; no descriptors
  std::vector<std::uint8_t> descriptors; ///< `bytes` for each
  Index size() const { return places.points.cols(); }
};

ImageFeatures findFeatures(const RgbdPyramid& pyramid, const RgbdCameras& cameras);

/// Poses that many features of two frames agree on, a from b, most votes first.
registration::PoseHypotheses matchFrames(const ImageFeatures& a, const ImageFeatures& b);
} // namespace fresco::tracking
