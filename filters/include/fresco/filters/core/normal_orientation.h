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
} // namespace fresco
