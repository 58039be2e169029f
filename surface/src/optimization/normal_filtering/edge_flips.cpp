// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/normal_filtering/edge_flips.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
using Eigen::Vector3d;
using Triangle = std::array<int, 3>;

// An edge a-b with its faces (a, b, c) and (b, a, d).
struct Quad {
  int a = -1, b = -1, c = -1, d = -1, left = -1, right = -1;
};

class Flipper {
public:
  Flipper(const OptimizationProblem& problem, const FacePoints& lists, double noise)
      : graph_(problem.graph), x_(problem.x), data_(problem.data), lists_(lists), noise_(noise)
  {}

  // How much less the total curvature is after the flip; 0 where it must not be done.
  double gain(Index edge) const
  {
    constexpr double least_gain = 0.05; // edge lengths times radians: 3 degrees at an edge; flat parts are left alone
    Quad q;
    if (!quadOf(edge, q) || !isAllowed(q))
      return 0.0;
    const Triangle old_left{q.a, q.b, q.c}, old_right{q.b, q.a, q.d}, left{q.a, q.d, q.c}, right{q.d, q.b, q.c};
    const double gain = edgeCurvature(old_left, old_right) +
                        outerCurvature(q, old_left, old_right, old_left, old_right) - edgeCurvature(left, right) -
                        outerCurvature(q, left, right, right, left);
    return gain > least_gain && keepsData(q, {old_left, old_right}, {left, right}) ? gain : 0.0;
  }

  bool quadOf(Index edge, Quad& q) const
  {
    const auto [f, g] = graph_.edge_faces[edge];
    if (f < 0 || g < 0)
      return false;
    for (int k = 0; k < 3; ++k)
      if (graph_.face_edges(k, f) == edge)
        q = {graph_.faces(k, f), graph_.faces((k + 1) % 3, f), graph_.faces((k + 2) % 3, f), -1, f, g};
    for (int k = 0; k < 3; ++k)
      if (graph_.face_edges(k, g) == edge && graph_.faces(k, g) == q.b) // else the two faces do not run the same way
        q.d = graph_.faces((k + 2) % 3, g);
    return q.d >= 0;
  }

private:
  Vector3d areaVector(const Triangle& t) const
  {
    return (x_.col(t[1]) - x_.col(t[0])).cross(x_.col(t[2]) - x_.col(t[0]));
  }
  Vector3d areaVector(int f) const { return areaVector({graph_.faces(0, f), graph_.faces(1, f), graph_.faces(2, f)}); }

  static double angle(const Vector3d& m, const Vector3d& n) { return std::atan2(m.cross(n).norm(), m.dot(n)); }

  // Length times dihedral angle of the edge that two triangles share.
  double edgeCurvature(const Triangle& s, const Triangle& t) const
  {
    std::array<int, 2> shared{};
    std::size_t count = 0;
    for (const int v : s)
      if (std::find(t.begin(), t.end(), v) != t.end() && count < 2)
        shared[count++] = v;
    return (x_.col(shared[0]) - x_.col(shared[1])).norm() * angle(areaVector(s), areaVector(t));
  }

  // Curvature at the four sides of the quad, given which triangle lies at side (b,c), (d,b), (c,a) and (a,d).
  double outerCurvature(const Quad& q, const Triangle& at_ca_or_left, const Triangle& at_db_or_right,
                        const Triangle& at_bc, const Triangle& at_ad) const
  {
    return sideCurvature(q, q.c, q.a, at_ca_or_left) + sideCurvature(q, q.d, q.b, at_db_or_right) +
           sideCurvature(q, q.b, q.c, at_bc) + sideCurvature(q, q.a, q.d, at_ad);
  }

  double sideCurvature(const Quad& q, int from, int to, const Triangle& inside) const
  {
    for (const int f : {q.left, q.right})
      for (int k = 0; k < 3; ++k)
        if (graph_.faces(k, f) == from && graph_.faces((k + 1) % 3, f) == to) {
          const int beyond = graph_.across(f, k);
          return beyond < 0 ? 0.0 : (x_.col(from) - x_.col(to)).norm() * angle(areaVector(inside), areaVector(beyond));
        }
    return 0.0;
  }

  bool isAllowed(const Quad& q) const
  {
    constexpr double least_height = 0.1; // of a new triangle over its new side, mean edge lengths: else a needle
    if (q.c == q.d || edgesAround(graph_, q.a).size() < 4 || edgesAround(graph_, q.b).size() < 4)
      return false;
    for (const int e : edgesAround(graph_, q.c))
      if (graph_.otherVertex(e, q.c) == q.d)
        return false;
    const Vector3d mean = areaVector(q.left) + areaVector(q.right);
    const double length = (x_.col(q.c) - x_.col(q.d)).norm();
    for (const Vector3d& n : {areaVector({q.a, q.d, q.c}), areaVector({q.d, q.b, q.c})})
      if (n.dot(mean) <= 0.0 || n.norm() < least_height * length)
        return false;
    return true;
  }

  double squaredDistance(const Vector3d& p, const Triangle& t) const
  {
    const Vector3d n = areaVector(t);
    const double height = n.dot(p - x_.col(t[0])) / std::max(n.norm(), 1e-12);
    return height * height;
  }

  bool keepsData(const Quad& q, const std::array<Triangle, 2>& before, const std::array<Triangle, 2>& after) const
  {
    double old_sum = 0.0, new_sum = 0.0, count = 0.0;
    for (const int f : {q.left, q.right})
      for (int j = lists_.begin[f]; j < lists_.begin[f + 1]; ++j) {
        const Vector3d p = data_.points.col(lists_.order[j]).cast<double>();
        old_sum += std::min(squaredDistance(p, before[0]), squaredDistance(p, before[1]));
        new_sum += std::min(squaredDistance(p, after[0]), squaredDistance(p, after[1]));
        ++count;
      }
    return new_sum <= old_sum + 0.1 * count * noise_ * noise_ + 1e-6;
  }

  const MeshGraph& graph_;
  const Positions& x_;
  const DataPoints& data_;
  const FacePoints& lists_;
  double noise_;
};

// The faces of the quad and those beyond its sides: their curvature was part of the decision.
std::array<int, 6> facesConcerned(const MeshGraph& graph, const Quad& q)
{
  std::array<int, 6> faces{q.left, q.right, -1, -1, -1, -1};
  std::size_t count = 2;
  for (const int f : {q.left, q.right})
    for (int k = 0; k < 3; ++k) {
      const int beyond = graph.across(f, k);
      if (beyond >= 0 && beyond != q.left && beyond != q.right)
        faces[count++] = beyond;
    }
  return faces;
}

// Edges that gain, the largest gain first.
std::vector<int> bestFirst(const OptimizationProblem& problem, const Flipper& flipper, int threads)
{
  std::vector<double> gains(problem.graph.edgeCount());
  parallelFor(problem.graph.edgeCount(), threads, [&](Index e) {
    const auto [a, b] = problem.graph.edges[e];
    gains[e] = problem.coverage.vertex[a] && problem.coverage.vertex[b] ? flipper.gain(e) : 0.0;
  });
  std::vector<int> order;
  for (int e = 0; e < problem.graph.edgeCount(); ++e)
    if (gains[e] > 0.0)
      order.push_back(e);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return gains[a] > gains[b]; });
  return order;
}

// Flips in that order, leaving out what touches an earlier one: its gain is not what it was, and two flips at one
// vertex could make the same edge.
Index flipApart(const MeshGraph& graph, const Flipper& flipper, const std::vector<int>& order, Faces& faces)
{
  std::vector<char> used(graph.faceCount(), 0), touched(graph.vertexCount(), 0);
  Index count = 0;
  for (const int e : order) {
    Quad q;
    flipper.quadOf(e, q);
    const std::array<int, 6> concerned = facesConcerned(graph, q);
    if (std::any_of(concerned.begin(), concerned.end(), [&](int f) { return f >= 0 && used[f]; }) || touched[q.a] ||
        touched[q.b] || touched[q.c] || touched[q.d])
      continue;
    for (const int f : concerned)
      if (f >= 0)
        used[f] = 1;
    for (const int v : {q.a, q.b, q.c, q.d})
      touched[v] = 1;
    faces.col(q.left) << q.a, q.d, q.c;
    faces.col(q.right) << q.d, q.b, q.c;
    ++count;
  }
  return count;
}
} // namespace

Index flipEdges(OptimizationProblem& problem, double noise, int threads)
{
  const FacePoints lists = pointsOfFaces(problem.data, problem.graph.faceCount());
  const Flipper flipper(problem, lists, noise);
  Faces faces = problem.graph.faces;
  const Index count = flipApart(problem.graph, flipper, bestFirst(problem, flipper, threads), faces);
  if (count > 0)
    problem.graph = buildGraph(faces, problem.graph.vertexCount(), threads);
  return count;
}
} // namespace fresco::optimization
