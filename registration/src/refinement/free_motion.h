// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/rigid_motion.h"
#include <fresco/registration/core/scan_registration.h>
#include <optional>
namespace fresco::registration {
/// The motion that the surfaces which hold a scan leave free, if any. Rotations are those about the place where these
/// surfaces tell least of them, wherever the scan's frame lies.
/// @param information see JointResult
std::optional<FreeMotion> findFreeMotion(const Matrix6d& information);
} // namespace fresco::registration
