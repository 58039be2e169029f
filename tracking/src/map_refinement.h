// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tracking_map.h"
#include <fresco/core/progress.h>
namespace fresco::tracking {
/// Key frames that edges hold together.
struct Submaps {
  std::vector<Index> of;     ///< per key frame
  std::vector<Index> frames; ///< per submap, frames of the video
};
Submaps findSubmaps(const TrackingMap& map);

/// Poses of all key frames in the frames of their submaps, by a robust pose graph; the first of each is the identity.
IsometryVector solvePoses(const TrackingMap& map, const IsometryVector& start);

/// Start for solvePoses(): along the edges, those between neighbours in time first.
IsometryVector chainPoses(const TrackingMap& map);

/// One round of: all key frames that see the same surfaces are aligned with each other; their edges replace those there
/// were; the graph is solved again.
void refineMap(TrackingMap& map, IsometryVector& poses, int threads, const Progress& progress);
} // namespace fresco::tracking
