// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/node_field.h"
#include "poisson/samples/samples.h"
#include "poisson/solver/constraints.h"
#include "poisson/solver/free_places.h"
#include <fresco/core/progress.h>
#include <vector>
namespace fresco::poisson {
/// Samples joined in the cells of each depth, by depth.
using SampleLevels = std::vector<SampleLevel>;

/// @param normals of the finest samples
SampleLevels sampleLevels(SampleLevel&& finest, const Array<Eigen::Vector3f>& normals, const Octree& tree, int threads);

/// What determines chi.
struct PoissonProblem {
  const Octree& tree;
  const FreePlaces& free_places;
  Constraints& constraints;
  SampleLevels& levels;
};

struct Solution {
  std::vector<NodeField> chi; ///< by depth, from the complete depth on
  double residual = 0;        ///< VolumetricResult::residual, before free space is asked for
};

/// Frees what it does not need any more: of `levels` all but the finest remain empty.
Solution solve(const PoissonProblem& problem, const VolumetricOptions& options, const Progress& progress);
} // namespace fresco::poisson
