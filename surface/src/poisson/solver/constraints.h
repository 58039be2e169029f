// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/node_field.h"
#include "poisson/samples/samples.h"
namespace fresco::poisson {
/// Right-hand sides b_j = integral V . grad B_j of all depths (Kazhdan, Bolitho & Hoppe 2006, sections 4.2, 4.3 and
/// 4.5), divided by the depth's cell side. V is the normal field: each sample's normal times its area, spread over a
/// cell of the depth that its density sustains to either side. Then chi is linear across the surface as far as the hat
/// functions around it reach, and its level set is where theirs is. A box does that with the least blur, for points
/// that are sparse against the finest cells. Where they sustain the finest depth the field is spread twice. That hides
/// the directions of the grid and costs no detail, because there the points themselves hold the surface.
struct Constraints {
  /// By depth: what was splatted at this depth or a finer one; without rims where the octree is not complete.
  std::vector<NodeField> fine;
  std::vector<NodeField> own; ///< by depth: what was splatted at this depth; empty at the finest
};

/// @param samples of the finest depth
/// @param normals of the samples, unit; freed as soon as they are not needed any more
Constraints splatNormals(const Octree& tree, const SampleLevel& samples, Array<Eigen::Vector3f>&& normals, int threads);

/// Adds to the right-hand side of a depth what was splatted at coarser ones, interpolated. These must be complete, so
/// depths come in rising order. `own` of the next coarser depth is freed.
void addCoarser(const Octree& tree, int depth, int threads, Constraints& constraints);
} // namespace fresco::poisson
