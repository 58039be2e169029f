// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
#include "poisson/samples/samples.h"
namespace fresco::poisson {
/// Takes the area from samples that lie scattered in space, outliers: they are of no surface. Of a group of samples,
/// neighbours in the octree, let h = n . (p - mean p). h is 0 on a plane, and the same for all on both sides of a sheet,
/// around a rod and at a corner. With l, the largest eigenvalue of mean n n^T,
///
///   3/2 min(1, 3 var(h) / mean |p - mean p|^2)  (1 - l)  (1 - |mean n|)
///
/// is 0 there, and about 1 where positions and normals are random.
void weighScattered(const Octree& tree, Samples& samples, int threads);
} // namespace fresco::poisson
