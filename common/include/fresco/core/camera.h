// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <string>
#include <vector>
namespace fresco {
/// Perspective camera with radial and tangential distortion (the OPENCV model of COLMAP; simpler models have zeros).
/// Axes: x right, y down, z forward. Pixels: (0,0) is the upper left corner of the upper left pixel, whose centre
/// lies at (0.5, 0.5).
struct CameraModel {
  int width = 0, height = 0;             ///< pixels
  double fx = 0, fy = 0, cx = 0, cy = 0; ///< pixels
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0; ///< distortion, dimensionless

  bool hasDistortion() const { return k1 != 0 || k2 != 0 || p1 != 0 || p2 != 0; }
};

/// One photograph.
struct View {
  std::string image; ///< file name, relative to the folder of images
  int camera = 0;    ///< index into CameraSet::cameras
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();

  Eigen::Vector3d center() const { return -(T_camera_world.linear().transpose() * T_camera_world.translation()); }
};

struct CameraSet {
  std::vector<CameraModel> cameras;
  std::vector<View> views;
};

/// @throws std::invalid_argument unless the image has 1..1,000,000 pixels a side, the focal lengths are 1e-3..1e6 times as
///         long, the centre is within 1e6 of that, and distortion within 1e6: what no camera exceeds, and what can be
///         computed with
FRESCO_EXPORT void validateCamera(const CameraModel& camera);

/// Pixel of a point given in the camera's frame; z must be positive.
FRESCO_EXPORT Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& point);

/// Direction (z = 1) in the camera's frame that `pixel` looks along; distortion is inverted iteratively.
FRESCO_EXPORT Eigen::Vector3d unproject(const CameraModel& camera, const Eigen::Vector2d& pixel);
} // namespace fresco
