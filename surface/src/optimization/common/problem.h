// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/data_coverage.h"
#include <fresco/surface/core/surface_optimization.h>
namespace fresco::optimization {
/// What both algorithms work on.
struct OptimizationProblem {
  MeshGraph graph;
  WorkingFrame frame;
  Positions start, x; ///< at the beginning and now; columns of vertices without faces are not used
  DataPoints data;
  DataCoverage coverage;
  Eigen::VectorXf start_distance; ///< of each datum from its face at the start
};

/// Residual in mean edge lengths at which a datum has lost three quarters of its weight. A reconstruction is off by a
/// cell at most, about one and a half edges, so that what is off by twice as much is an outlier.
constexpr double outlier_distance = 3.0;

/// The options that both algorithms have.
/// @throws std::invalid_argument if one is out of range
void validateOptions(int iterations, double smoothness_weight, double shape_weight, double tolerance);

/// @throws std::invalid_argument if the mesh or the points are not valid, or no point is near the mesh
OptimizationProblem makeProblem(const TriangleMesh& mesh, const PointSet& points, int threads);

/// Puts back what is inverted at the end, and fills `result` but for iterations and converged.
void finish(const TriangleMesh& mesh, OptimizationProblem& problem, int threads, SurfaceOptimizationResult& result);

/// RMS of the columns where `counts` is set.
double rmsMove(const Positions& move, const std::vector<char>& counts, int threads);
} // namespace fresco::optimization
