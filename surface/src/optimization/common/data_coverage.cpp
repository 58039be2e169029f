// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/data_coverage.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
#include <limits>
namespace fresco::optimization {
namespace {
using Eigen::Vector3d;

struct Seeds {
  std::vector<int> of_vertex; // face with points, or -1
  Eigen::Matrix3Xf middle;    // F, mean of the face's points
};

Eigen::Matrix3Xf middles(const DataPoints& data, const FacePoints& lists, Index faces, int threads)
{
  Eigen::Matrix3Xf middle = Eigen::Matrix3Xf::Zero(3, faces);
  parallelFor(faces, threads, [&](Index f) {
    for (int i = lists.begin[f]; i < lists.begin[f + 1]; ++i)
      middle.col(f) += data.points.col(lists.order[i]);
    const float count = lists.count(f);
    if (count > 0.f)
      middle.col(f) /= count;
  });
  return middle;
}

// Nearer seed for v, of `seed` and `best`; the smaller index where both are equally far.
void improve(const Eigen::Matrix3Xf& middle, const Vector3d& v, int seed, int& best, double& squared)
{
  if (seed < 0 || seed == best)
    return;
  const double own = (middle.col(seed).cast<double>() - v).squaredNorm();
  if (own < squared || (own == squared && seed < best)) {
    squared = own;
    best = seed;
  }
}

std::vector<int> firstSeeds(const MeshGraph& graph, const Positions& x, const FacePoints& lists,
                            const Eigen::Matrix3Xf& middle, int threads)
{
  std::vector<int> seed(graph.vertexCount(), -1);
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    double squared = std::numeric_limits<double>::infinity();
    for (const int f : facesAround(graph, v))
      if (lists.count(f) > 0)
        improve(middle, x.col(v), f, seed[v], squared);
  });
  return seed;
}

Seeds spreadSeeds(const MeshGraph& graph, const Positions& x, const DataPoints& data, const FacePoints& lists,
                  int threads)
{
  constexpr int most_rings = 24; // data so sparse that they are farther apart say nothing of what lies between
  Seeds seeds;
  seeds.middle = middles(data, lists, graph.faceCount(), threads);
  seeds.of_vertex = firstSeeds(graph, x, lists, seeds.middle, threads);
  std::vector<int> next(seeds.of_vertex.size());
  for (int ring = 0; ring < most_rings; ++ring) {
    const Index changes = parallelSum(graph.vertexCount(), threads, Index{0}, [&](Index v) -> Index {
      int best = seeds.of_vertex[v];
      double squared = best < 0 ? std::numeric_limits<double>::infinity()
                                : (seeds.middle.col(best).cast<double>() - x.col(v)).squaredNorm();
      for (const int e : edgesAround(graph, v))
        improve(seeds.middle, x.col(v), seeds.of_vertex[graph.otherVertex(e, v)], best, squared);
      next[v] = best;
      return best != seeds.of_vertex[v] ? 1 : 0;
    });
    seeds.of_vertex.swap(next);
    if (changes == 0)
      break;
  }
  return seeds;
}

// Distance of each seed to its second nearest neighbour: one close companion says nothing of the others.
std::vector<double> seedSpacing(const MeshGraph& graph, const Seeds& seeds, Index faces)
{
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> first(faces, none), second(faces, none);
  std::vector<int> nearest(faces, -1);
  const auto tell = [&](int seed, int other, double distance) {
    if (nearest[seed] == other)
      return;
    if (distance < first[seed]) {
      second[seed] = first[seed];
      first[seed] = distance;
      nearest[seed] = other;
    } else if (distance < second[seed]) {
      second[seed] = distance;
    }
  };
  for (const auto& [a, b] : graph.edges) {
    const int s = seeds.of_vertex[a], t = seeds.of_vertex[b];
    if (s < 0 || t < 0 || s == t)
      continue;
    const double distance = (seeds.middle.col(s) - seeds.middle.col(t)).cast<double>().norm();
    tell(s, t, distance);
    tell(t, s, distance);
  }
  for (std::size_t s = 0; s < first.size(); ++s)
    if (second[s] == none)
      second[s] = first[s] == none ? 0.0 : first[s];
  return second;
}

std::vector<double> vertexAreas(const MeshGraph& graph, const Positions& x, int threads)
{
  const Eigen::Matrix3Xd normals = areaVectors(graph, x, threads);
  std::vector<double> areas(graph.vertexCount(), 0.0);
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    for (const int f : facesAround(graph, v))
      areas[v] += normals.col(f).norm() / 6.0;
  });
  return areas;
}
} // namespace

DataCoverage findCoverage(const MeshGraph& graph, const Positions& x, const DataPoints& data, const FacePoints& lists,
                          int threads)
{
  // Lengths of an edge, or of the distance between neighbouring data where that is longer: two and a half pass over one
  // missing datum, but not over two.
  constexpr double reach_lengths = 2.5;
  const Seeds seeds = spreadSeeds(graph, x, data, lists, threads);
  const std::vector<double> spacing = seedSpacing(graph, seeds, graph.faceCount());
  const std::vector<double> areas = vertexAreas(graph, x, threads);
  DataCoverage coverage;
  coverage.vertex.assign(graph.vertexCount(), 0);
  Eigen::VectorXf face_area = Eigen::VectorXf::Zero(graph.faceCount());
  for (Index v = 0; v < graph.vertexCount(); ++v) {
    const int s = seeds.of_vertex[v];
    if (s < 0)
      continue;
    const double reach = reach_lengths * std::max(1.0, spacing[s]);
    if ((seeds.middle.col(s).cast<double>() - x.col(v)).norm() > reach)
      continue;
    coverage.vertex[v] = 1;
    const float area = areas[v];
    face_area[s] += area;
  }
  coverage.point_weight.setZero(data.size());
  std::vector<float> spacings;
  for (Index i = 0; i < data.size(); ++i) {
    const Index f = data.face[i];
    const float count = lists.count(f);
    coverage.point_weight[i] = face_area[f] / count;
    if (coverage.point_weight[i] > 0.f)
      spacings.push_back(std::sqrt(coverage.point_weight[i]));
  }
  if (!spacings.empty())
    coverage.spacing = median(spacings);
  return coverage;
}
} // namespace fresco::optimization
