// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/worsening_guard.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <limits>
namespace fresco::optimization {
namespace {
using Eigen::Vector3d;

constexpr float corners = 3.f; // of a face: each datum counts at all

template <int Rows>
using VertexValues = Eigen::Matrix<float, Rows, Eigen::Dynamic>;

// Each vertex takes the mean of its own and its neighbours' values, `rounds` times.
template <int Rows>
void average(const MeshGraph& graph, VertexValues<Rows>& values, int rounds, int threads)
{
  VertexValues<Rows> next(Rows, values.cols());
  for (int round = 0; round < rounds; ++round) {
    parallelFor(values.cols(), threads, [&](Index v) {
      Eigen::Matrix<float, Rows, 1> sum = values.col(v);
      for (const int e : edgesAround(graph, v))
        sum += values.col(graph.otherVertex(e, v));
      next.col(v) = sum / (1.f + edgesAround(graph, v).size());
    });
    values.swap(next);
  }
}

// Sums over the data around each vertex: distance at the start, distance now, number.
VertexValues<3> fitAround(const OptimizationProblem& problem, const FacePoints& lists, int threads)
{
  const Eigen::VectorXf now = dataDistances(problem.graph, problem.x, problem.data, threads);
  VertexValues<3> fit = VertexValues<3>::Zero(3, problem.graph.vertexCount());
  parallelFor(problem.graph.vertexCount(), threads, [&](Index v) {
    for (const int f : facesAround(problem.graph, v))
      for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j) {
        const int i = lists.order[j];
        if (std::max(problem.start_distance[i], now[i]) < outlier_distance)
          fit.col(v) += Eigen::Vector3f(problem.start_distance[i], now[i], 1.f);
      }
  });
  return fit;
}

// How much of the move of a vertex its data allow: all where they are no farther off than before or than their noise
// explains, nothing where they are by `worse`, or where there are none.
float partByFit(const Eigen::Vector3f& fit, float explained)
{
  // A surface with a free parameter a vertex follows the noise of n data a vertex, which are nearer to it for that by
  // half of 1 / n. Smoothing may take as much. Measured: docs/measurements/optimization.md.
  constexpr double most_worse = 0.25;
  if (!(fit[2] > 0.f))
    return 0.f;
  const double worse = 1.0 + std::min(most_worse, 0.5 * corners / fit[2]);
  return ramp(fit[1] / std::max(fit[0], explained * fit[2]), worse, 1.0);
}

// How much of the move of v does not lead away from all data, to where nothing says that there is a surface.
float partBySupport(const OptimizationProblem& problem, const FacePoints& lists, Index v)
{
  const double near = std::max(1.0, problem.coverage.spacing), away = 0.5 * near; // mean edge lengths
  const auto distance = [&](const Positions& of, int datum) {
    return (problem.data.points.col(datum).cast<double>() - of.col(v)).norm();
  };
  const std::vector<int>& nearest = problem.coverage.nearest;
  double now = std::numeric_limits<double>::infinity();
  for (const int e : edgesAround(problem.graph, v))
    if (const int datum = nearest[problem.graph.otherVertex(e, v)]; datum >= 0)
      now = std::min(now, distance(problem.x, datum));
  for (const int f : facesAround(problem.graph, v))
    for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j)
      now = std::min(now, distance(problem.x, lists.order[j]));
  if (nearest[v] < 0)
    return 1.f;
  const double before = std::max(near, distance(problem.start, nearest[v]));
  return ramp(std::min(now, distance(problem.x, nearest[v])), before + away, before);
}

// At a boundary vertex, the direction in which the surface of the start ends; zero elsewhere.
Vector3d endDirection(const OptimizationProblem& problem, Index v)
{
  const MeshGraph& graph = problem.graph;
  Vector3d sum = Vector3d::Zero();
  if (graph.border[v])
    for (const int f : facesAround(graph, v))
      for (int k = 0; k < 3; ++k) {
        const int a = graph.faces(k, f), b = graph.faces((k + 1) % 3, f);
        if ((a == v || b == v) && graph.across(f, k) < 0)
          sum += (problem.start.col(b) - problem.start.col(a)).cross(areaVector(graph, problem.start, f));
      }
  return sum.stableNormalized();
}
} // namespace

Eigen::VectorXf dataDistances(const MeshGraph& graph, const Positions& x, const DataPoints& data, int threads)
{
  Eigen::VectorXf distances(data.size());
  parallelFor(data.size(), threads, [&](Index i) {
    const Vector3d p = data.points.col(i).cast<double>();
    distances[i] = offsetFrom(graph, x, data.face[i], footOn(graph, x, data.face[i], p), p).norm();
  });
  return distances;
}

void undoWorsening(OptimizationProblem& problem, double noise, int threads)
{
  constexpr int rings = 10, blend_rings = 2; // of data, more where they are sparse; of parts
  followFaces(problem.graph, problem.x, problem.data, threads);
  const FacePoints lists = pointsOfFaces(problem.data, problem.graph.faceCount());
  VertexValues<3> fit = fitAround(problem, lists, threads);
  const double spacing = std::max(1.0, problem.coverage.spacing);
  average(problem.graph, fit, std::min<int>(most_rings, std::ceil(rings * spacing)), threads);
  // The mean magnitude of Gaussian values is 0.8 of their deviation.
  const float explained = std::max(least_noise, 0.8 * noise);
  VertexValues<1> part(problem.graph.vertexCount());
  parallelFor(part.size(), threads,
              [&](Index v) { part[v] = partByFit(fit.col(v), explained) * partBySupport(problem, lists, v); });
  average(problem.graph, part, blend_rings, threads);
  problem.x = (problem.x - problem.start) * part.cast<double>().asDiagonal();
  smoothAlongBoundary(problem.graph, problem.coverage.nearness, problem.x, threads);
  parallelFor(part.size(), threads, [&](Index v) {
    // Data do not tell where a surface ends, so its boundary moves across it only.
    const Vector3d way = problem.x.col(v), end = endDirection(problem, v);
    problem.x.col(v) = problem.start.col(v) + way - way.dot(end) * end;
  });
}
} // namespace fresco::optimization
