// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "volumetric_octree.h"
#include "volumetric_samples.h"
namespace fresco::volumetric {
/// Right-hand sides b_i = integral V . grad B_i of all depths, divided by the
/// depth's cell side. V is the normal field: each sample's normal times its
/// area, spread over a cell of the depth that its density sustains.
struct Constraints {
  std::vector<NodeField> fine; ///< by depth: what was splatted at this depth or a finer one
  std::vector<NodeField> own;  ///< by depth: what was splatted at this depth; empty at the finest
};

Constraints splatNormals(const Octree& tree, const Samples& samples, int threads);
} // namespace fresco::volumetric
