// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "stages/stages.h"
#include <fresco/rendering/viewpoint.h>
#include <optional>
namespace fresco::model {
/// Upright direction: that of the frame for scans; for RGB-D frames and projects of photographs, whose world may be tilted,
/// the mean of the cameras'.
std::optional<Eigen::Vector3d> uprightOf(const Job& job);

/// Where a photograph was taken, with its opening angle.
rendering::Viewpoint viewOf(const CameraModel& camera, const Eigen::Isometry3d& T_world_camera);

/// From where each scan was taken, level to the middle of the model.
std::vector<rendering::Viewpoint> viewsFromScans(const Job& job, const TriangleMesh& mesh, const Eigen::Vector3d& up);

bool isLevel(const rendering::Viewpoint& view, const Eigen::Vector3d& up);

/// Views of the photographs that look about level; all of them where none does.
std::vector<rendering::Viewpoint> levelViews(const Job& job, const Eigen::Vector3d& up);

/// Numbers of `count` views that differ most in place and direction, the first one first (farthest point sampling).
/// @param views at least one
std::vector<std::size_t> variedViews(const std::vector<rendering::Viewpoint>& views, std::size_t count);

std::vector<rendering::Viewpoint> chosen(const std::vector<rendering::Viewpoint>& views,
                                         const std::vector<std::size_t>& numbers);
} // namespace fresco::model
