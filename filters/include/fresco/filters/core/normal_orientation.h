// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
namespace fresco {
/// Turns each normal to the side of its viewpoint: n . (v - p) >= 0. Non-finite points and normals stay as they are.
/// @param viewpoints 3xN or 3x1
/// @throws std::invalid_argument if sizes differ
FRESCO_EXPORT void orientToViewpoints(const Points& points, const Points& viewpoints, Points& normals, int threads = 0);

/// Turns normals so that neighbours agree, and closed objects outward, where no viewpoint is known: signs are passed on
/// along the minimum spanning tree of the graph of the 10 nearest neighbours (Hoppe et al. 1992); whether two normals
/// agree is told after one is mirrored at the plane between the points (König & Gumhold 2009, "Consistent propagation
/// of normal orientations in point clouds"), which holds across sharp edges too. Each connected part is then turned as
/// a whole so that the volume it encloses is positive. Non-finite points and normals stay as they are.
/// @param normals 3xN unit
/// @throws std::invalid_argument if sizes differ
FRESCO_EXPORT void orientByNeighbors(const Points& points, Points& normals, int threads = 0);

/// What is known of where a cloud was seen from.
struct FreeSideHints {
  Points sensors;       ///< 3xM places of the sensor in the frame of the points, or 3x0
  bool outside = false; ///< a thing was seen from around; else the cloud was seen from within its bounds, as rooms are
};

/// The same for a cloud of rooms, whose free side is within: where each part of the tree stands, and each patch within which
/// normals agree all but certainly, is told by the space around it. The side is free on which a sensor is in sight, or on which
/// the way along the normals to the next points is longer. A way that leaves the cloud counts as none, of a thing seen from
/// around as the longest.
FRESCO_EXPORT void orientToFreeSide(const Points& points, const FreeSideHints& hints, Points& normals, int threads = 0);
} // namespace fresco
