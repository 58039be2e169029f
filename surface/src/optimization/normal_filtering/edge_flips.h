// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/problem.h"
namespace fresco::optimization {
/// One round of edge flips: an edge is exchanged for the other diagonal of its two faces where that lowers the total
/// curvature (edge length times angle between the normals, over the five edges concerned), so that edges come to lie
/// along creases, and does not move the surface away from its data. No vertex moves; no edge becomes non-manifold.
/// @return number of edges flipped
Index flipEdges(OptimizationProblem& problem, double noise, int threads);
} // namespace fresco::optimization
