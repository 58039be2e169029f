// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/problem.h"
#include "optimization/common/inversion_guard.h"
#include "optimization/common/worsening_guard.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/machine_memory.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/union_find.h>
#include <utility>
namespace fresco::optimization {
namespace {
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

// Turns the patches of faces, neighbours oriented alike, that more points look against than with.
// Returns the number of faces turned.
Index turnOpposed(const MeshGraph& graph, const std::vector<int>& votes, Faces& faces)
{
  if (std::none_of(votes.begin(), votes.end(), [](int vote) { return vote < 0; }))
    return 0;
  const auto runs_upwards = [&](Index e, int f) {
    const int low = graph.edges[e][0], high = graph.edges[e][1];
    return (faces(0, f) == low && faces(1, f) == high) || (faces(1, f) == low && faces(2, f) == high) ||
           (faces(2, f) == low && faces(0, f) == high);
  };
  UnionFind patches(graph.faceCount());
  for (Index e = 0; e < graph.edgeCount(); ++e)
    if (const auto [a, b] = graph.edge_faces[e]; a >= 0 && b >= 0 && runs_upwards(e, a) != runs_upwards(e, b))
      patches.join(a, b);
  std::vector<Index> sum(graph.faceCount(), 0);
  for (Index f = 0; f < graph.faceCount(); ++f)
    sum[patches.root(f)] += votes[f];
  Index turned = 0;
  for (Index f = 0; f < graph.faceCount(); ++f)
    if (sum[patches.root(f)] < 0) {
      std::swap(faces(1, f), faces(2, f));
      ++turned;
    }
  return turned;
}

TriangleMesh movedMesh(const TriangleMesh& mesh, const OptimizationProblem& problem, int threads)
{
  TriangleMesh moved = mesh;
  moved.faces = problem.graph.faces;
  const Eigen::Vector3d shift = problem.frame.center - mesh.origin;
  parallelFor(mesh.vertexCount(), threads, [&](Index v) {
    if ((problem.graph.border[v] || problem.x.col(v) != problem.start.col(v)) && problem.coverage.vertex[v] &&
        facesAround(problem.graph, v).size() > 0)
      moved.vertices.col(v) = (problem.frame.unit * problem.x.col(v) + shift).cast<float>();
  });
  if (mesh.normals.cols() > 0)
    moved.normals = vertexNormals(moved, threads);
  return moved;
}
} // namespace

OptimizationProblem makeProblem(const TriangleMesh& mesh, const PointSet& points, int threads)
{
  const double reach = 2 * outlier_distance; // mean edge lengths: beyond, a datum hardly has weight
  require(mesh.faceCount() > 0, "optimisation: the mesh has no faces");
  validateMesh(mesh);
  validatePointSet(points);
  require(points.size() > 0, "optimisation: no points");
  constexpr std::size_t megabyte = 1000000;
  const std::size_t needed = optimizationMemory(mesh.faceCount(), points.size()), there = machineMemory();
  if (needed > there)
    throw std::runtime_error(concat("optimisation: ", mesh.faceCount(), " faces and ", points.size(),
                                    " points take about ", needed / megabyte, " MB of memory, there are ",
                                    there / megabyte, "; a mesh of larger cells takes less"));
  OptimizationProblem problem;
  problem.graph = buildGraph(mesh.faces, mesh.vertexCount(), threads);
  const Eigen::Vector3d middle = middleOf(mesh, problem.graph);
  Positions x = mesh.vertices.cast<double>().colwise() - middle;
  problem.frame.center = mesh.origin + middle;
  problem.frame.unit = meanEdgeLength(problem.graph, x, threads);
  require(problem.frame.unit > 0 && surfaceArea(mesh) > 0, "optimisation: the mesh has no area");
  problem.x = x / problem.frame.unit;
  problem.start = problem.x;
  const auto find_data = [&] {
    problem.data = findCorrespondences(problem.graph, problem.x, points, problem.frame, reach, threads);
  };
  find_data();
  Faces faces = mesh.faces;
  problem.turned_faces = turnOpposed(problem.graph, problem.data.votes, faces);
  if (problem.turned_faces > 0) {
    problem.graph = buildGraph(faces, mesh.vertexCount(), threads);
    find_data();
  }
  problem.data.votes = {};
  require(problem.data.size() > 0, "optimisation: no finite point lies within ", reach * problem.frame.unit, " (",
          reach, " mean edge lengths) of the mesh");
  problem.coverage = findCoverage(problem.graph, problem.x, problem.data,
                                  sharePoints(problem.graph, problem.x, problem.data, threads), threads);
  // In more detail than their distance data do not tell where a surface ends.
  smoothAlongBoundary(problem.graph, problem.coverage.nearness, problem.start, threads);
  const Positions way = problem.start - problem.x;
  const Eigen::ArrayXd moves = way.colwise().norm(), spacing = problem.coverage.rate.cwiseSqrt();
  problem.x += way * (spacing / moves.max(1e-12)).min(1.0).matrix().asDiagonal();
  problem.start = problem.x;
  problem.start_distance = dataDistances(problem.graph, problem.x, problem.data, threads);
  return problem;
}

void finish(const TriangleMesh& mesh, OptimizationProblem& problem, int threads, NormalFilteringResult& result)
{
  const std::vector<char>& covered = problem.coverage.vertex;
  result.edge_length = problem.frame.unit;
  result.spacing = problem.coverage.spacing * problem.frame.unit;
  result.used_points = problem.data.size();
  result.left_out_points = problem.data.left_out;
  result.turned_faces = problem.turned_faces;
  result.covered_vertices = std::count(covered.begin(), covered.end(), char{1});
  undoWorsening(problem, result.noise / problem.frame.unit, threads);
  result.restored_vertices =
      repairInverted(problem.graph, problem.start, problem.coverage.nearness, problem.x, threads);
  result.mesh = movedMesh(mesh, problem, threads);
}
} // namespace fresco::optimization

std::size_t fresco::optimizationMemory(Index faces, Index points)
{
  constexpr std::size_t per_face = 400, per_point = 65; // bytes, measured: docs/measurements/optimization.md
  return per_face * static_cast<std::size_t>(faces) + per_point * static_cast<std::size_t>(points);
}
