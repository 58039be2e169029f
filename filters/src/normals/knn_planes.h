// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "normals/plane_fit.h"
namespace fresco::filters {
struct Fits {
  std::vector<Plane> planes;
  std::vector<float> reaches; ///< squared distance to the farthest neighbour
};

/// The `k` nearest of each point of all.tree with the least squares planes through them. Neighbourhoods that noise
/// makes as thick as wide have no normal: where the scan is so dense, the plane is fitted to points spread evenly over
/// a wider disc, `k` of which are the list. So it is where the nearest lie on a line but for the noise, those of one
/// row of beams, if a wider disc has a plane.
/// @param k 1..Neighborhoods::most_neighbors
Fits fitNearest(Neighborhoods& all, int k, int threads);

/// Planes through the lists of all.groups.
Fits fitLists(const Neighborhoods& all, int threads);
} // namespace fresco::filters
