// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "joint_refinement.h"
#include <fresco/registration/core/scan_registration.h>
#include <optional>
namespace fresco {
struct PoseUncertainty {
  double translation = 0.0; ///< standard deviation in the least certain direction, length
  double rotation = 0.0;    ///< about the least certain axis, radian
  std::optional<FreeMotion> free_motion;
};

/// @param information see JointResult
/// @param rms         of the point-to-plane distances, length
/// @param size        length that makes rotations comparable with translations
PoseUncertainty describeUncertainty(const Matrix6d& information, double rms, double size);
} // namespace fresco
