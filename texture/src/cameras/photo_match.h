// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "cameras/grey_pyramid.h"
#include "photographs/grid.h"
#include "photographs/photo_store.h"
#include "photographs/projector.h"
#include <algorithm>
#include <fresco/search/ray_scene.h>
namespace fresco::texture {
/// Cameras that are being refined, in mesh coordinates.
struct CameraState {
  std::vector<CameraModel> cameras;             ///< one per group of views that share it
  std::vector<int> group;                       ///< V
  std::vector<Eigen::Isometry3d> T_camera_mesh; ///< V
  std::vector<int> pose;                        ///< V, number of the pose; parts of one panorama share it
  std::vector<Eigen::Matrix3d> R_part_view;     ///< V, from the axes that the pose has
  std::vector<char> fixed_lens;                 ///< of the cameras: parts of panoramas have no lens
};

/// One place of the surface in two photographs.
struct PhotoMatch {
  int from, to;                         ///< views
  Eigen::Vector2d pixel_from, pixel_to; ///< of the photographs
  Eigen::Vector3d point, normal;        ///< plane of the surface there
};

/// Photographs prepared for matching.
struct MatchPhoto {
  GreyPyramid pyramid;
  std::vector<Eigen::Vector2f> corners; ///< pixels of the pyramid's level 0
  std::vector<bool> used;               ///< pixels of level 0 that the mask leaves; empty: all

  bool uses(const Eigen::Vector2f& pixel) const
  {
    const int width = pyramid.levels[0].width, height = pyramid.levels[0].height;
    return used.empty() ||
           used[cellAt(std::clamp<int>(pixel.x(), 0, width - 1), std::clamp<int>(pixel.y(), 0, height - 1), width)];
  }
};

struct MatchOptions {
  double search = 32; ///< pixels of the photograph around the expected place
  int partners = 8;   ///< views that each view is compared with
  int threads = 0;
};

/// Corners of each photograph found again in others that see the same surface, as they look from there.
std::vector<PhotoMatch> matchPhotos(const RayScene& scene, const std::vector<MatchPhoto>& photos,
                                    const CameraState& state, const MatchOptions& options);
} // namespace fresco::texture
