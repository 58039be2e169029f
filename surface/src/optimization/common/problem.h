// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/data_coverage.h"
#include <fresco/surface/core/normal_filtering.h>
namespace fresco::optimization {
/// What an optimisation works on.
struct OptimizationProblem {
  MeshGraph graph;
  WorkingFrame frame;
  Positions start, x;     ///< at the beginning and now; columns of vertices without faces are not used
  Index turned_faces = 0; ///< of the input that are oriented the other way in `graph`
  DataPoints data;
  DataCoverage coverage;
  Eigen::VectorXf start_distance; ///< of each datum from its face at the start
};

/// Residual in mean edge lengths at which a datum has lost three quarters of its weight. A reconstruction is off by a
/// cell at most, about one and a half edges, so that what is off by twice as much is an outlier.
constexpr double outlier_distance = 3.0;

constexpr double least_noise = 0.01; ///< mean edge lengths: exact data on curved surfaces are off flat faces by as much

/// @throws std::invalid_argument if the mesh or the points are not valid, or no point is near the mesh
OptimizationProblem makeProblem(const TriangleMesh& mesh, const PointSet& points, int threads);

/// Puts back what is inverted at the end, and fills what `result` says of mesh and points.
void finish(const TriangleMesh& mesh, OptimizationProblem& problem, int threads, NormalFilteringResult& result);
} // namespace fresco::optimization
