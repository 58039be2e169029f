// SPDX-License-Identifier: BSD-3-Clause
#include "charts/chart.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <fresco/core/parallel.h>
#include <map>
#include <numeric>
namespace fresco::texture {
namespace {
constexpr int smoothing_rounds = 6; // reaches as many faces far: evens out noise, keeps furniture apart

Points smoothed(const FaceGraph& graph, Points values, int threads)
{
  for (int round = 0; round < smoothing_rounds; ++round) {
    Points next(3, values.cols());
    parallelFor(values.cols(), threads, [&](Index f) {
      Eigen::Vector3f sum = graph.areas[f] * values.col(f);
      for (int k = 0; k < 3; ++k)
        if (const int other = graph.neighbors(k, f); other >= 0)
          sum += graph.areas[other] * values.col(other);
      next.col(f) = sum.stableNormalized();
    });
    values.swap(next);
  }
  return values;
}

/// Mean cosine between the smooth normal of each face and those of its neighbours' neighbours.
Eigen::VectorXf flatness(const FaceGraph& graph, int threads)
{
  Points mean = graph.smooth_normals;
  for (int round = 0; round < smoothing_rounds; ++round) {
    Points next(3, mean.cols());
    parallelFor(mean.cols(), threads, [&](Index f) {
      Eigen::Vector3f sum = mean.col(f);
      float count = 1;
      for (int k = 0; k < 3; ++k)
        if (const int other = graph.neighbors(k, f); other >= 0) {
          sum += mean.col(other);
          ++count;
        }
      next.col(f) = sum / count;
    });
    mean.swap(next);
  }
  return mean.colwise().norm();
}

class Segmentation {
public:
  Segmentation(const FaceGraph& graph, const std::vector<int>& faces) : graph_(graph), chart_(graph.areas.size(), taken)
  {
    for (const int f : faces)
      chart_[f] = open;
  }

  std::vector<Chart> run(const std::vector<int>& faces)
  {
    for (const int seed : faces)
      if (chart_[seed] == open)
        growFrom(seed);
    mergeSmallCharts();
    charts_.erase(std::remove_if(charts_.begin(), charts_.end(), [](const Chart& c) { return c.faces.empty(); }),
                  charts_.end());
    return std::move(charts_);
  }

private:
  enum : int { open = -1, taken = -2 };

  bool fits(int f, const Eigen::Vector3f& axis) const
  {
    constexpr float least_cosine = 0.5f;        // 60 degrees: half the resolution is lost in one direction at most
    constexpr float least_smooth_cosine = 0.7f; // 45 degrees, of the surroundings: noise alone ends no chart
    return chart_[f] == open && graph_.normals.col(f).dot(axis) > least_cosine &&
           graph_.smooth_normals.col(f).dot(axis) > least_smooth_cosine;
  }

  /// Open faces joined with the seed that fit the axis, breadth first; they become part of chart `id`.
  std::vector<int> flood(int seed, const Eigen::Vector3f& axis, int id)
  {
    std::vector<int> faces{seed};
    chart_[seed] = id;
    for (std::size_t i = 0; i < faces.size(); ++i)
      for (int k = 0; k < 3; ++k)
        if (const int other = graph_.neighbors(k, faces[i]); other >= 0 && fits(other, axis)) {
          chart_[other] = id;
          faces.push_back(other);
        }
    return faces;
  }

  void growFrom(int seed)
  {
    const int id = charts_.size();
    const std::vector<int> first = flood(seed, graph_.smooth_normals.col(seed), id);
    Eigen::Vector3f axis = Eigen::Vector3f::Zero();
    for (const int f : first)
      axis += graph_.areas[f] * graph_.normals.col(f);
    axis.stableNormalize();
    for (const int f : first)
      chart_[f] = open;
    Chart chart;
    chart.axis = fits(seed, axis) ? axis : Eigen::Vector3f(graph_.normals.col(seed));
    chart.faces = flood(seed, chart.axis, id);
    charts_.push_back(std::move(chart));
  }

  /// The neighbour that shares the longest border and can take all faces of chart c; -1 = none.
  int hostOf(int c) const
  {
    std::map<int, int> shared; // edges per neighbour
    for (const int f : charts_[c].faces)
      for (int k = 0; k < 3; ++k)
        if (const int other = graph_.neighbors(k, f); other >= 0 && chart_[other] >= 0 && chart_[other] != c)
          ++shared[chart_[other]];
    int best = -1, most = 0;
    for (const auto& [host, edges] : shared) {
      const auto turned = [&, axis = charts_[host].axis](int f) {
        return graph_.normals.col(f).dot(axis) > steep_cosine; // accepted: each small chart would cost a border
      };
      if (edges > most && std::all_of(charts_[c].faces.begin(), charts_[c].faces.end(), turned)) {
        best = host;
        most = edges;
      }
    }
    return best;
  }

  void mergeSmallCharts()
  {
    constexpr std::size_t small_chart = 64; // faces: fewer are not worth a border of their own
    std::vector<int> order(charts_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return charts_[a].faces.size() < charts_[b].faces.size(); });
    for (const int c : order) {
      if (charts_[c].faces.size() > small_chart)
        continue;
      const int host = hostOf(c);
      if (host < 0)
        continue;
      for (const int f : charts_[c].faces)
        chart_[f] = host;
      charts_[host].faces.insert(charts_[host].faces.end(), charts_[c].faces.begin(), charts_[c].faces.end());
      charts_[c].faces.clear();
    }
  }

  const FaceGraph& graph_;
  std::vector<int> chart_;
  std::vector<Chart> charts_;
};
} // namespace

FaceGraph buildFaceGraph(const TriangleMesh& mesh, int threads)
{
  FaceGraph graph;
  const Index n = mesh.faceCount();
  graph.normals = faceNormals(mesh, threads);
  graph.neighbors = faceNeighbors(mesh.faces, threads);
  graph.areas.resize(n);
  parallelFor(n, threads, [&](Index f) { graph.areas[f] = 0.5 * areaVector(mesh, f).norm(); });
  graph.smooth_normals = smoothed(graph, graph.normals, threads);
  const Eigen::VectorXf flat = flatness(graph, threads);
  for (Index f = 0; f < n; ++f)
    if (graph.areas[f] > 0 && graph.normals.col(f).squaredNorm() > 0)
      graph.seeds.push_back(f);
  std::stable_sort(graph.seeds.begin(), graph.seeds.end(), [&](int a, int b) { return flat[a] > flat[b]; });
  return graph;
}

double weightedQuantile(std::vector<std::pair<double, double>> values, double share)
{
  std::sort(values.begin(), values.end());
  double total = 0, sum = 0;
  for (const auto& [value, weight] : values)
    total += weight;
  for (const auto& [value, weight] : values)
    if ((sum += weight) >= share * total)
      return value;
  return values.back().first;
}

std::vector<Chart> segmentFaces(const FaceGraph& graph, const std::vector<int>& faces)
{
  return Segmentation(graph, faces).run(faces);
}
} // namespace fresco::texture
