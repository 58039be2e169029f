// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/surface/core/surface_optimization.h>

#include "optimization/common/inversion_guard.h"
#include "optimization/common/problem.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
namespace fresco {
using namespace optimization;
namespace {

constexpr double reach = 6.0; // mean edge lengths: points farther from the mesh are of something else

void validate(const TriangleMesh& mesh, const PointSet& points, const SurfaceOptimizationOptions& options)
{
  require(mesh.faceCount() > 0, "optimisation: the mesh has no faces");
  validateMesh(mesh);
  validatePointSet(points);
  require(points.size() > 0, "optimisation: no points");
  require(options.iterations >= 0 && options.iterations <= 10000, "optimisation: ", options.iterations,
          " iterations are not in 0..10000");
  require(std::isfinite(options.kappa1) && std::isfinite(options.kappa2), "optimisation: a weight is not finite");
  require(options.tolerance >= 0 && std::isfinite(options.tolerance), "optimisation: tolerance ", options.tolerance,
          " is negative or not finite");
}

// Mean of the vertices that faces name.
Eigen::Vector3d middleOf(const TriangleMesh& mesh, const MeshGraph& graph)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    if (facesAround(graph, v).size() > 0) {
      sum += mesh.vertices.col(v).cast<double>();
      ++count;
    }
  return count > 0 ? (sum / count).eval() : sum;
}

OptimizationProblem makeProblem(const TriangleMesh& mesh, const PointSet& points, int threads)
{
  OptimizationProblem problem;
  problem.graph = buildGraph(mesh.faces, mesh.vertexCount(), threads);
  const Eigen::Vector3d middle = middleOf(mesh, problem.graph);
  Positions x = mesh.vertices.cast<double>().colwise() - middle;
  problem.frame.center = mesh.origin + middle;
  problem.frame.unit = meanEdgeLength(problem.graph, x, threads);
  require(problem.frame.unit > 0 && surfaceArea(mesh) > 0, "optimisation: the mesh has no area");
  problem.x = x / problem.frame.unit;
  problem.start = problem.x;
  problem.data = findCorrespondences(problem.graph, problem.x, points, problem.frame, reach, threads);
  require(problem.data.size() > 0, "optimisation: no finite point lies within ", reach * problem.frame.unit, " (",
          reach, " mean edge lengths) of the mesh");
  problem.support = findSupport(problem.graph, problem.x, problem.data,
                                pointsOfFaces(problem.data, problem.graph.faceCount()), threads);
  return problem;
}

TriangleMesh movedMesh(const TriangleMesh& mesh, const OptimizationProblem& problem, int threads)
{
  TriangleMesh moved = mesh;
  moved.faces = problem.graph.faces;
  const Eigen::Vector3d shift = problem.frame.center - mesh.origin;
  parallelFor(mesh.vertexCount(), threads, [&](Index v) {
    if (problem.x.col(v) != problem.start.col(v) && facesAround(problem.graph, v).size() > 0)
      moved.vertices.col(v) = (problem.frame.unit * problem.x.col(v) + shift).cast<float>();
  });
  if (mesh.normals.cols() > 0)
    moved.normals = vertexNormals(moved, threads);
  return moved;
}
} // namespace

double optimization::robustDeviation(std::vector<float>& magnitudes)
{
  if (magnitudes.empty())
    return 0.0;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return 1.4826 * static_cast<double>(*middle);
}

double optimization::rmsMove(const Positions& move, const std::vector<char>& counts, int threads)
{
  const double sum =
      parallelSum(move.cols(), threads, 0.0, [&](Index v) { return counts[v] ? move.col(v).squaredNorm() : 0.0; });
  const auto number = std::count(counts.begin(), counts.end(), char{1});
  return number > 0 ? std::sqrt(sum / static_cast<double>(number)) : 0.0;
}

SurfaceOptimizationResult optimizeSurface(const TriangleMesh& mesh, const PointSet& points,
                                          const SurfaceOptimizationOptions& options, const Progress& progress)
{
  validate(mesh, points, options);
  report(progress, "correspondences", 0.0);
  OptimizationProblem problem = makeProblem(mesh, points, options.threads);
  SurfaceOptimizationResult result;
  result.edge_length = problem.frame.unit;
  result.used_points = problem.data.size();
  result.left_out_points = problem.data.left_out;
  result.spacing = problem.support.spacing * problem.frame.unit;
  result.supported_vertices = std::count(problem.support.vertex.begin(), problem.support.vertex.end(), char{1});
  (options.mode == OptimizationMode::best ? runBest : runFaithful)(problem, options, progress, result);
  report(progress, "check", 0.95);
  result.noise *= problem.frame.unit;
  result.restored_vertices = unfold(problem.graph, problem.start, problem.support.vertex, problem.x, options.threads);
  result.mesh = movedMesh(mesh, problem, options.threads);
  return result;
}
} // namespace fresco
