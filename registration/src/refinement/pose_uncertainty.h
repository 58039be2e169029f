// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/joint_refinement.h"
#include <fresco/registration/core/scan_registration.h>
#include <optional>
namespace fresco::registration {
struct PoseUncertainty {
  double translation = 0.0; ///< standard deviation in the least certain direction, length
  double rotation = 0.0;    ///< about the least certain axis, radian
  std::optional<FreeMotion> free_motion;
};

/// Of a scan's pose. Rotations are those about the middle of its points, wherever its frame's origin lies.
/// @param information see JointResult
/// @param rms         of the point-to-plane distances, length
/// @param R_world_scan of the scan's pose
PoseUncertainty describeUncertainty(const Matrix6d& information, double rms, const PreparedScan& scan,
                                    const Eigen::Matrix3d& R_world_scan);
} // namespace fresco::registration
