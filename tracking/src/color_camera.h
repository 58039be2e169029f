// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "reference_frame.h"
#include <fresco/core/rigid_motion.h>
namespace fresco::tracking {
/// Two frames whose relative pose is known from their depths.
struct CalibrationPair {
  RgbdPyramid reference, current;
  Eigen::Isometry3d T_current_reference = Eigen::Isometry3d::Identity();
};

/// Focal length, centre and place of the colour camera under which points of one frame have the same intensity in the
/// other: Levenberg-Marquardt with weights of a t distribution. What the pairs leave free stays where it was.
RgbdCameras calibrateColorCamera(const std::vector<CalibrationPair>& pairs, const RgbdCameras& start, int threads);
} // namespace fresco::tracking
