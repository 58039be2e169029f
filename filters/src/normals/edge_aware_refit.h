// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "normals/plane_fit.h"
#include <fresco/core/point_set.h>
namespace fresco::filters {
/// Beside an edge a neighbourhood holds points of both sides and its plane is a mean of theirs. There the fit is
/// replaced: of the planes of the neighbours, the flattest that holds the point is taken and fitted again to the
/// neighbours of both that lie near it. Done three times (two where no viewpoint is known): the first time reaches the
/// points whose neighbours lie on one side, the others those nearer to the edge.
///
/// Where planes of both sides hold the point within its noise, the ray from the viewpoint tells: noise moves a point
/// along it only, and of two planes that meet in a crease the ray meets the nearer first where they form a hollow, the
/// farther where they form a ridge.
/// @param set what `all` was made of: viewpoints
void refitAtEdges(const PointSet& set, const Neighborhoods& all, std::vector<Plane>& planes, int threads);
} // namespace fresco::filters
