// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/mesh_graph.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {

bool isDegenerate(const Faces& faces, Index f)
{
  return faces(0, f) == faces(1, f) || faces(1, f) == faces(2, f) || faces(2, f) == faces(0, f);
}

void runningSum(std::vector<int>& counts)
{
  int sum = 0;
  for (int& count : counts) {
    const int own = count;
    count = sum;
    sum += own;
  }
}

void collectVertexFaces(MeshGraph& graph)
{
  const Index faces = graph.faceCount();
  for (Index f = 0; f < faces; ++f)
    if (!isDegenerate(graph.faces, f))
      for (int k = 0; k < 3; ++k)
        ++graph.face_begin[graph.faces(k, f)];
  runningSum(graph.face_begin);
  graph.vertex_faces.resize(graph.face_begin.back());
  std::vector<int> next(graph.face_begin.begin(), graph.face_begin.end() - 1);
  for (int f = 0; f < faces; ++f)
    if (!isDegenerate(graph.faces, f))
      for (int k = 0; k < 3; ++k)
        graph.vertex_faces[next[graph.faces(k, f)]++] = f;
}

// A side of a face, seen from its vertex with the smaller index.
struct Side {
  int other, face, corner;
  bool operator<(const Side& s) const { return other != s.other ? other < s.other : face < s.face; }
};

void sidesFrom(const MeshGraph& graph, Index v, std::vector<Side>& sides)
{
  sides.clear();
  for (const int f : facesAround(graph, v))
    for (int k = 0; k < 3; ++k) {
      const int a = graph.faces(k, f), b = graph.faces((k + 1) % 3, f);
      if (std::min(a, b) == v)
        sides.push_back({std::max(a, b), f, k});
    }
  std::sort(sides.begin(), sides.end());
}

// Number of different edges in `sides`; each is told with its first and last side.
template <typename Visit>
int forEachEdge(const std::vector<Side>& sides, const Visit& visit)
{
  int count = 0;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i;
    while (j < sides.size() && sides[j].other == sides[i].other)
      ++j;
    visit(count++, i, j);
    i = j;
  }
  return count;
}

void collectEdges(MeshGraph& graph, int threads)
{
  const Index vertices = graph.vertexCount();
  std::vector<int> first(vertices + 1, 0);
  parallelRanges(vertices, threads, [&](Index begin, Index end) {
    std::vector<Side> sides;
    for (Index v = begin; v < end; ++v) {
      sidesFrom(graph, v, sides);
      first[v] = forEachEdge(sides, [](int, std::size_t, std::size_t) {});
    }
  });
  runningSum(first);
  graph.edges.resize(first.back());
  graph.edge_faces.assign(graph.edges.size(), {-1, -1});
  graph.face_edges.setConstant(3, graph.faceCount(), -1);
  parallelRanges(vertices, threads, [&](Index begin, Index end) {
    std::vector<Side> sides;
    for (Index v = begin; v < end; ++v) {
      sidesFrom(graph, v, sides);
      forEachEdge(sides, [&](int rank, std::size_t i, std::size_t j) {
        const int edge = first[v] + rank;
        graph.edges[edge][0] = v;
        graph.edges[edge][1] = sides[i].other;
        if (j - i <= 2)
          graph.edge_faces[edge] = {sides[i].face, j - i == 2 ? sides[i + 1].face : -1};
        for (std::size_t s = i; s < j; ++s)
          graph.face_edges(sides[s].corner, sides[s].face) = edge;
      });
    }
  });
}

void collectVertexEdges(MeshGraph& graph)
{
  graph.edge_begin.assign(graph.face_begin.size(), 0);
  for (const auto& edge : graph.edges)
    for (const int v : edge)
      ++graph.edge_begin[v];
  runningSum(graph.edge_begin);
  graph.vertex_edges.resize(2 * graph.edges.size());
  std::vector<int> next(graph.edge_begin.begin(), graph.edge_begin.end() - 1);
  for (int e = 0; e < graph.edgeCount(); ++e)
    for (const int v : graph.edges[e]) {
      graph.vertex_edges[next[v]++] = e;
      if (graph.edge_faces[e][1] < 0)
        graph.border[v] = 1;
    }
}
} // namespace

MeshGraph buildGraph(const Faces& faces, Index vertices, int threads)
{
  MeshGraph graph;
  graph.faces = faces;
  graph.face_begin.assign(vertices + 1, 0);
  graph.border.assign(vertices, 0);
  collectVertexFaces(graph);
  collectEdges(graph, threads);
  collectVertexEdges(graph);
  return graph;
}

Eigen::Matrix3Xd areaVectors(const MeshGraph& graph, const Positions& x, int threads)
{
  Eigen::Matrix3Xd vectors(3, graph.faceCount());
  parallelFor(graph.faceCount(), threads, [&](Index f) {
    if (graph.face_edges(0, f) < 0)
      vectors.col(f).setZero();
    else
      vectors.col(f) = areaVector(graph, x, f);
  });
  return vectors;
}

void smoothAlongBoundary(const MeshGraph& graph, const Eigen::VectorXf& part, Positions& values, int threads)
{
  constexpr double factors[] = {0.5, 1.0 / (0.05 - 1.0 / 0.5)}; // shrink, grow; 0.05 = 1 - cos(2 pi / 20)
  std::vector<std::array<int, 3>> curve;                        // vertices, each between its two neighbours
  for (int v = 0; v < graph.vertexCount(); ++v) {
    std::vector<int> beside;
    for (const int e : edgesAround(graph, v))
      if (graph.edge_faces[e][0] >= 0 && graph.edge_faces[e][1] < 0)
        beside.push_back(graph.otherVertex(e, v));
    if (beside.size() == 2)
      curve.push_back({beside[0], v, beside[1]});
  }
  Positions step(3, curve.size());
  for (int round = 0; round < 80; ++round) { // leave a wave of 20 vertices, a quarter of one of 7, nothing of one of 5
    parallelFor(curve.size(), threads, [&](Index i) {
      const auto [a, v, b] = curve[i];
      step.col(i) = factors[round % 2] * part[v] * (0.5 * (values.col(a) + values.col(b)) - values.col(v));
    });
    parallelFor(curve.size(), threads, [&](Index i) { values.col(curve[i][1]) += step.col(i); });
  }
}

double meanEdgeLength(const MeshGraph& graph, const Positions& x, int threads)
{
  const double sum = parallelSum(graph.edgeCount(), threads, 0.0, [&](Index e) {
    const auto [a, b] = graph.edges[e];
    return (x.col(a) - x.col(b)).norm();
  });
  const double count = std::max<Index>(graph.edgeCount(), 1);
  return sum / count;
}
} // namespace fresco::optimization
