// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
#include "poisson/samples/samples.h"
#include "poisson/solver/constraints.h"
namespace fresco::poisson {
/// Of chi from the level set, which is at -0.05..0.05, where no surface may be: on the cube's boundary and where beams
/// passed. Chi jumps by 1 at the surface.
constexpr float clear_margin = 0.1f;

/// Solves the depths at which the octree is complete, one after the other, with free (Neumann) boundary: conjugate
/// gradients on a dense grid. The solution is shifted so that its mean over the samples is 0. Its values on the cube's
/// boundary are made to have one sign, the prevailing one, so that no level set leaves the cube.
/// @param right  right-hand sides of depths 2..full_depth
/// @param levels samples by the depth of the cells in which they are joined
/// @return chi at depth full_depth
NodeField solveBase(const Octree& tree, const std::vector<NodeField>& right, const std::vector<SampleLevel>& levels,
                    float point_weight, int threads);
} // namespace fresco::poisson
