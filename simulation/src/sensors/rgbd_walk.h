// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/progress.h>
#include <fresco/simulation/scene/places.h>
#include <fresco/simulation/sensors/photograph.h>
#include <string>
namespace fresco::simulation {
/// An RGB-D camera that somebody carries through a scene.
struct RgbdWalkOptions {
  int frames = 0;                ///< 30 a second, 0..100000
  int width = 640, height = 480; ///< pixels
  int jpeg_quality = 90;         ///< 1..100
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Poses of the walk, world from camera: from place to place on clear paths, at most 0.45 m a second, the view swinging.
/// @throws std::runtime_error if there is no free place
std::vector<Eigen::Isometry3d> planWalk(const PlanningInput& input, int frames);

/// Depths as a camera of structured light measures them, millimetres, 0 = none: Barron, Malik 2013, "Intrinsic Scene
/// Properties from a Single RGB-D Image": disparities are jittered sideways, noisy and whole numbers. Beside edges and on
/// grazing surfaces half of the pixels have none.
Image16 takeDepthImage(const LitScene& lit, const Shot& shot, int threads);

/// Writes camera-intrinsics.txt, frame-NNNNNN.{color.jpg,depth.png} and the true poses.txt into `folder`; colour and
/// depth images are of one camera.
void writeRgbdWalk(const LitScene& lit, const std::string& folder, const std::vector<Eigen::Isometry3d>& T_world_camera,
                   const RgbdWalkOptions& options, const Progress& progress);
} // namespace fresco::simulation
