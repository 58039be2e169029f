// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/types.h>
namespace fresco::alignment {
/// 3xN, where the pixels of their tracks see the points: the place with the least squares of angles, in pixels, between
/// it and the rays of its track. Where the rays do not meet, hardly differ or are not known it is the given position.
Eigen::Matrix3Xd triangulateTracks(const CameraSet& set, const SparsePoints& points, int threads);
} // namespace fresco::alignment
