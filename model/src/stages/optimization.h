// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_set.h>
namespace fresco::model {
/// The points as they are while there are at most 16 a vertex; else averaged in cells of a third of `cell`, with the
/// attributes that the optimisation of a surface uses.
/// @param points   with normals
/// @param vertices of the surface that was reconstructed with cells of `cell`, length unit of the points, > 0
PointSet pointsForVertices(PointSet points, Index vertices, double cell);
} // namespace fresco::model
