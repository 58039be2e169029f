// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "cameras/photo_match.h"
namespace fresco::texture {
constexpr double exact_pixels = 0.3; ///< what matching errs by where cameras and mesh are exact

/// How far cameras may be off; standard deviations.
struct AdjustmentPrior {
  double pose_shift = 0.02; ///< mesh units, each view
  double pose_turn = 0.01;  ///< radians, each view
  double mount_shift = 0.1; ///< mesh units, all views of a camera alike: it sits beside the sensor with the given poses
  double mount_turn = 0.05; ///< radians, likewise
  double focal = 0.15;      ///< share of the focal length
  double center = 0.03;     ///< share of the image's width
  double distortion = 0.1;  ///< of k1; half of it for k2
};

/// Distance in pixels between where each match is and where the cameras and the surface say it should be.
std::vector<double> matchErrors(const std::vector<PhotoMatch>& matches, const CameraState& state);

/// Robust least squares (Cauchy weights, Levenberg-Marquardt) over poses and what the views of each camera share:
/// mount, focal length, principal point, radial distortion. The place where a ray meets the surface slides on the
/// match's plane.
/// @param initial the cameras that the prior is about
CameraState adjustCameras(const std::vector<PhotoMatch>& matches, const CameraState& initial,
                          const AdjustmentPrior& prior, int threads);
} // namespace fresco::texture
