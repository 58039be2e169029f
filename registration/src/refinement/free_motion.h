// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/rigid_motion.h"
#include "scan/prepared_scan.h"
#include <fresco/registration/core/scan_registration.h>
#include <optional>
namespace fresco::registration {
/// The motion that a scan's surfaces leave free, if any. Rotations are those about the middle of its points, wherever its
/// frame's origin lies.
/// @param information see JointResult
/// @param R_world_scan of the scan's pose
std::optional<FreeMotion> findFreeMotion(const Matrix6d& information, const PreparedScan& scan,
                                         const Eigen::Matrix3d& R_world_scan);
} // namespace fresco::registration
