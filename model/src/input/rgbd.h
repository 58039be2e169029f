// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/image.h>
#include <fresco/core/point_set.h>
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

struct DepthOptions {
  double nearest = 0.3, farthest = 5.0; ///< metres, range that is used
  int stride = 2;                       ///< every stride-th pixel in both directions, >= 1
  double radius = 0.018;                ///< of the fitted plane as a share of the distance: sensor noise grows with it
  double grazing = 75.0;                ///< degrees between beam and normal beyond which a pixel is dropped, 0..90
};

/// Points of a depth image with normals: a plane is fitted around each pixel and the point moved onto it along its
/// beam. Pixels without depth, at depth jumps and at grazing incidence are dropped.
/// @param depth millimetres; 0 and 65535 = none
/// @return in the camera's frame, metres; normals towards the camera; confidence = cos(incidence) / depth^2, for noise
///         that grows with depth^2; viewpoint (0,0,0)
PointSet depthPoints(const Image16& depth, const CameraModel& camera, const DepthOptions& options, int threads);
} // namespace fresco::model
