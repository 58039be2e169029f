// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/rigid_motion.h>
#include <fresco/registration/core/scan_registration.h>
#include <optional>
namespace fresco::registration {
/// The motion that surfaces tell least of.
struct WeakestMotion {
  FreeMotion motion;
  double share = 0.0; ///< of the information of it in that of all directions, 0..1
};

/// Nothing if there is no information. @param information see JointResult
std::optional<WeakestMotion> findWeakestMotion(const Matrix6d& information);

/// The motion that the surfaces which hold a scan leave free, if any. Rotations are those about the place where these
/// surfaces tell least of them, wherever the scan's frame lies.
/// @param information see JointResult
std::optional<FreeMotion> findFreeMotion(const Matrix6d& information);
} // namespace fresco::registration
