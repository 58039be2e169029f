// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/node_field.h"
#include <fresco/core/parallel.h>
namespace fresco::poisson {
/// Values at the nodes of a child brick, interpolated trilinearly from the nodes of its parent.
/// @param parent 125 nodes
/// @param child  125 nodes, overwritten
void interpolateToChild(const float* parent, int octant, float* child);

/// parent += factor * P^T child, with P the interpolation above.
/// @param child 125 nodes
void restrictToParent(const float* child, int octant, float factor, float* parent);

/// receive(brick, its 125 nodes) for the bricks of a depth, with values interpolated from the next coarser depth.
template <typename Receive>
void interpolateLevel(const Octree& tree, int depth, const NodeField& coarse, int threads, const Receive& receive)
{
  const BrickLevel& parents = tree.levels[depth - 1];
  parallelFor(parents.size(), threads, [&](Index p) {
    if (parents.child_octants[p] == 0)
      return;
    float parent[nodes_per_brick], child[nodes_per_brick];
    coarse.load(parents, p, parent);
    for (int octant = 0; octant < 8; ++octant)
      if (const int b = parents.child(p, octant); b >= 0) {
        interpolateToChild(parent, octant, child);
        receive(Index(b), child);
      }
  });
}

/// coarse += factor * P^T fine, each node counted once.
void restrictLevel(const BrickLevel& fine_level, const NodeField& fine, const BrickLevel& coarse_level, float factor,
                   NodeField& coarse, int threads);
} // namespace fresco::poisson
