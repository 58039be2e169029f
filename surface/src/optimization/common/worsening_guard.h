// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/problem.h"
namespace fresco::optimization {
/// Distance of each datum from its face at x, mean edge lengths.
Eigen::VectorXf dataDistances(const MeshGraph& graph, const Positions& x, const DataPoints& data, int threads);

/// Vertices go back towards the start where the data around them are farther from the surface than they were there and
/// than their noise explains, and where they have moved away from all data. Finds the faces of the data anew.
/// @param noise deviation of the data, mean edge lengths
void undoWorsening(OptimizationProblem& problem, double noise, int threads);
} // namespace fresco::optimization
