// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tracking_map.h"
#include <fresco/core/progress.h>
namespace fresco::tracking {
constexpr std::size_t most_alike = 24; ///< key frames that each is compared with by features

/// Pairs of key frames that look alike, agree on a pose by their features, and align densely with that in both
/// directions, become edges of the map.
/// @return number of pairs
Index closeLoops(TrackingMap& map, int threads, const Progress& progress);

/// Pose of `b` seen from `a`, by features, then densely in both directions; two edges, or none.
KeyFrameEdges alignByFeatures(const TrackingMap& map, Index a, Index b);

/// Which key frames look most like a frame: by correlation of their coarsest images.
std::vector<Index> mostAlike(const std::vector<KeyFrame>& key_frames, const RgbdPyramid& frame);
} // namespace fresco::tracking
