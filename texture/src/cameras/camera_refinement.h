// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/photo_store.h"
#include <fresco/core/progress.h>
#include <fresco/search/ray_scene.h>
namespace fresco::texture {
/// Cameras made to agree with each other on the mesh.
struct RefinedCameras {
  std::vector<CameraModel> cameras;              ///< per view
  std::vector<Eigen::Isometry3d> T_camera_world; ///< per view
  double before = 0, after = 0; ///< pixels, median distance between matched places and where the cameras say they are
  Index matches = 0;            ///< of the last round
  bool changed = false;         ///< false: they agreed already, or there were too few matches
};

/// @param views views with equal camera models share one camera
RefinedCameras refineCameras(const TriangleMesh& mesh, const RayScene& scene, const std::vector<TextureView>& views,
                             PhotoStore& photos, int threads, const Progress& progress);
} // namespace fresco::texture
