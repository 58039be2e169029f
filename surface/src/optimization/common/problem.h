// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/data_coverage.h"
#include <fresco/core/progress.h>
#include <fresco/surface/core/surface_optimization.h>
namespace fresco::optimization {
/// What both modes work on.
struct OptimizationProblem {
  MeshGraph graph;
  WorkingFrame frame;
  Positions start, x; ///< at the beginning and now; columns of vertices without faces are not used
  DataPoints data;
  Support support;
};

/// Iterations of the mode over problem.x; fills steps, converged, noise, flipped_edges.
void runBest(OptimizationProblem& problem, const SurfaceOptimizationOptions& options, const Progress& progress,
             SurfaceOptimizationResult& result);
void runFaithful(OptimizationProblem& problem, const SurfaceOptimizationOptions& options, const Progress& progress,
                 SurfaceOptimizationResult& result);

/// 1.4826 times the median: the deviation of Gaussian values of which these are the magnitudes. 0 without values.
double robustDeviation(std::vector<float>& magnitudes);

/// RMS of the columns where `counts` is set.
double rmsMove(const Positions& move, const std::vector<char>& counts, int threads);
} // namespace fresco::optimization
