// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <optional>
namespace fresco {
/// 4x4, world from scan; nothing for a scan that could not be placed.
using Pose = std::optional<Eigen::Matrix4d>;
} // namespace fresco
