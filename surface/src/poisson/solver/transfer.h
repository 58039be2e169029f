// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
namespace fresco::poisson {
/// Values at the nodes of a child brick, interpolated trilinearly from the nodes of its parent.
/// @param parent 125 nodes
/// @param child  125 nodes, overwritten
void interpolateToChild(const float* parent, int octant, float* child);

/// parent += factor * P^T child, with P the interpolation above.
/// @param child 125 nodes
void restrictToParent(const float* child, int octant, float factor, float* parent);

/// coarse += factor * P^T fine, each node counted once; upper faces of `coarse` are brought up to date.
void restrictLevel(const BrickLevel& fine_level, const NodeField& fine, const BrickLevel& coarse_level, float factor,
                   NodeField& coarse, int threads);
} // namespace fresco::poisson
