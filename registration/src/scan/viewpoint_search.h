// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/types.h>
#include <optional>
namespace fresco::registration {
/// The place that a scan of wide view was seen from, to a few centimetres in a room: there, no surface lies behind another
/// one. Nothing if the points do not surround it, if even from there many lie behind others, or if they do not tell it from
/// places around it, as in an empty room.
/// This costs about 50 times what isViewpoint() does: half a second.
/// @param points 3xN, finite
/// @param size   of the scan, length
std::optional<Eigen::Vector3f> findViewpoint(const Points& points, float size, int threads);

/// Whether what is said of the place holds for a given one, compared with those around it. Where the best place is some
/// centimetres away, this may be missed.
bool isViewpoint(const Points& points, const Eigen::Vector3f& place, float size, int threads);
} // namespace fresco::registration
