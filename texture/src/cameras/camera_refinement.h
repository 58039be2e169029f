// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/photo_store.h"
#include <fresco/core/progress.h>
#include <fresco/search/ray_scene.h>
namespace fresco::texture {
/// Cameras that agree so well are left alone: half a pixel is what matching itself errs by.
constexpr double agreement_pixels = 0.5;

/// What cameras are refined by.
struct RefinementInput {
  const TriangleMesh& mesh;
  const RayScene& scene;                 ///< of the mesh
  const std::vector<TextureView>& views; ///< those with equal camera models share one camera
  PhotoStore& photos;
};

/// Cameras made to agree with each other on the mesh.
struct RefinedCameras {
  std::vector<CameraModel> cameras;              ///< per view
  std::vector<Eigen::Isometry3d> T_camera_world; ///< per view
  double before = 0;    ///< pixels, median distance between matched points and where the given cameras project them
  double after = 0;     ///< the same with the refined cameras
  Index matches = 0;    ///< of the last round
  bool changed = false; ///< false: they agreed already, or there were too few matches
};

/// Bundle adjustment with the mesh as structure: alternates matching of photographs on the mesh with the adjustment of
/// poses and intrinsics; the search shrinks from round to round.
RefinedCameras refineCameras(const RefinementInput& input, int threads, const Progress& progress);
} // namespace fresco::texture
