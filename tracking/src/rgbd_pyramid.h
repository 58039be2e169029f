// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/array.h>
#include <fresco/tracking/core/rgbd_tracking.h>
#include <vector>
namespace fresco::tracking {
constexpr float one_surface = 0.03f; ///< of the depth: what differs more is another surface

/// Pinhole camera with pixel centres at integers.
struct Pinhole {
  float fx = 0, fy = 0, cx = 0, cy = 0;
};

/// The pinhole of a camera model whose image was halved `times`.
Pinhole halved(const CameraModel& camera, int times);

/// The two cameras of the device. The colour camera is not turned against the depth camera.
struct RgbdCameras {
  CameraModel depth, color;
  Eigen::Vector3f color_from_depth = Eigen::Vector3f::Zero();
};

template <typename T>
struct Plane2d {
  int width = 0, height = 0;
  Array<T> data;
  Plane2d() = default;
  Plane2d(int w, int h) : width(w), height(h), data(static_cast<std::size_t>(w) * h) {}
  T* row(int y) { return data.data() + static_cast<std::ptrdiff_t>(y) * width; }
  const T* row(int y) const { return data.data() + static_cast<std::ptrdiff_t>(y) * width; }
};
using Plane = Plane2d<float>;

/// One resolution of a frame.
struct RgbdLevel {
  Plane depth; ///< metres, 0 = none
  Plane gray;  ///< 0..255; empty if there is no colour image, or hardly any contrast in it
  int depth_halvings = 0, gray_halvings = 0; ///< of the images as they were taken
};

/// A frame at several resolutions, fine to coarse; the finest is at most 400 pixels wide.
struct RgbdPyramid {
  std::vector<RgbdLevel> levels;
  std::string problem;    ///< why the frame could not be read; empty = it was
  double depth_share = 0; ///< share of the pixels that have a depth, 0..1
};

struct DepthRules {
  double unit, nearest, farthest; ///< metres
};

RgbdPyramid makePyramid(const RgbdImage& image, const DepthRules& rules);
} // namespace fresco::tracking
