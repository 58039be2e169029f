// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/camera.h>
#include <fresco/core/export.h>
#include <fresco/core/image.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <functional>
#include <vector>
namespace fresco {
/// What a depth camera saw.
struct DepthFrames {
  CameraModel camera;                            ///< without distortion
  std::vector<Eigen::Isometry3d> T_world_camera; ///< a pose per frame
  std::function<DepthImage(Index frame)> depth;  ///< asked several times for each frame, one at a time
};

/// Volumetric fusion of signed distances, Curless & Levoy 1996, with a robust mean over the frames.
struct DepthFusionOptions {
  double cell = 0.01;        ///< side of a cell of the grid, > 0
  double truncation = 4;     ///< distance from a surface up to which a frame tells of it, in cells, 2..16
  double free_weight = 1.25; ///< weight of a frame that saw through a place, against one that saw a surface there, > 0
  bool refine_poses = false; ///< move the frames onto their common surface first
  int threads = 0;           ///< 0 = all cores; the result does not depend on it
};

struct DepthFusionResult {
  PointSet points; ///< one per cell that the surface passes, with normals to the free side and viewpoints; the
                   ///< confidence is the weight of the frames that saw it
  std::vector<Eigen::Isometry3d> T_world_camera; ///< as given, or refined
};

/// The common surface of depth images as points with normals.
/// @throws std::invalid_argument if there is no frame, a pose is not rigid, the camera has distortion, an image does not
///                               have the camera's size or an option is out of range
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT DepthFusionResult fuseDepthImages(const DepthFrames& frames, const DepthFusionOptions& options = {},
                                                const Progress& progress = {});
} // namespace fresco
