// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/inversion_guard.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
using Eigen::Vector3d;

constexpr int halvings = 5;         // of a move before it is given up
constexpr int relaxations = 3;      // before vertices go back
constexpr int limit_rounds = 40;    // a vertex given up can spoil its neighbours, but not for long
constexpr double least_area = 1e-4; // of a face, in squared mean edge lengths: it must not shrink below by a move

Vector3d areaVector(const MeshGraph& graph, const Positions& x, Index f)
{
  const Vector3d a = x.col(graph.faces(0, f));
  return (x.col(graph.faces(1, f)) - a).cross(x.col(graph.faces(2, f)) - a);
}

Vector3d movedAreaVector(const MeshGraph& graph, const Positions& x, const Positions& move, Index f)
{
  Vector3d corner[3];
  for (int k = 0; k < 3; ++k)
    corner[k] = x.col(graph.faces(k, f)) + move.col(graph.faces(k, f));
  return (corner[1] - corner[0]).cross(corner[2] - corner[0]);
}

bool isSpoiled(const MeshGraph& graph, const Positions& x, const Positions& move, const Vector3d& normal, Index f)
{
  if (graph.face_edges(0, f) < 0 || normal.squaredNorm() == 0.0)
    return false;
  const double after = movedAreaVector(graph, x, move, f).dot(normal);
  return after < least_area && after < areaVector(graph, x, f).dot(normal);
}
// Marks the corners of a folded face that can still be moved back, and where there is none, the ring around it: with
// all of that at the start the face cannot be folded. False if everything is there already.
bool touchFolded(const MeshGraph& graph, Index f, const std::vector<char>& times, std::vector<char>& touched)
{
  bool any = false;
  const auto touch = [&](Index v) {
    if (times[v] > halvings)
      return;
    touched[v] = 1;
    any = true;
  };
  for (int k = 0; k < 3; ++k)
    touch(graph.faces(k, f));
  if (any)
    return true;
  for (int k = 0; k < 3; ++k)
    for (const int g : facesAround(graph, graph.faces(k, f)))
      for (int j = 0; j < 3; ++j)
        touch(graph.faces(j, g));
  return any;
}
// Free vertices inside the surface that `which` names go to the middle of their neighbours.
template <typename Which>
void relaxWhere(const MeshGraph& graph, const std::vector<char>& free, Positions& x, int threads, const Which& which)
{
  const Positions before = x;
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    const IntRange edges = edgesAround(graph, v);
    if (!free[v] || graph.border[v] || edges.size() == 0 || !which(v))
      return;
    Vector3d sum = Vector3d::Zero();
    for (const int e : edges)
      sum += before.col(graph.otherVertex(e, static_cast<int>(v)));
    x.col(v) = sum / static_cast<double>(edges.size());
  });
}
} // namespace

void limitMoves(const MeshGraph& graph, const Positions& x, const Eigen::Matrix3Xf& normals, Positions& move,
                int threads)
{
  std::vector<char> spoiled(graph.faceCount()), times(graph.vertexCount(), 0);
  for (int round = 0; round < limit_rounds; ++round) {
    const Index count = parallelSum(graph.faceCount(), threads, Index{0}, [&](Index f) -> Index {
      spoiled[f] = isSpoiled(graph, x, move, normals.col(f).cast<double>(), f) ? 1 : 0;
      return spoiled[f];
    });
    if (count == 0)
      return;
    parallelFor(graph.vertexCount(), threads, [&](Index v) {
      for (const int f : facesAround(graph, v))
        if (spoiled[f]) {
          move.col(v) *= ++times[v] > halvings ? 0.0 : 0.5;
          times[v] = std::min<char>(times[v], halvings);
          return;
        }
    });
  }
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    for (const int f : facesAround(graph, v))
      if (spoiled[f])
        move.col(v).setZero();
  });
}

std::vector<char> foldedFaces(const MeshGraph& graph, const Positions& x, int threads)
{
  const Eigen::Matrix3Xd areas = areaVectors(graph, x, threads);
  Positions around = Positions::Zero(3, graph.vertexCount());
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    for (const int f : facesAround(graph, v))
      around.col(v) += areas.col(f);
  });
  std::vector<char> folded(graph.faceCount(), 0);
  parallelFor(graph.faceCount(), threads, [&](Index f) {
    if (graph.face_edges(0, f) < 0)
      return;
    Vector3d mean = Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      mean += around.col(graph.faces(k, f));
    folded[f] = areas.col(f).dot(mean) < 0.0 ? 1 : 0;
  });
  return folded;
}

void relaxFolds(const MeshGraph& graph, const std::vector<char>& free, Positions& x, int threads)
{
  const std::vector<char> folded = foldedFaces(graph, x, threads);
  relaxWhere(graph, free, x, threads, [&](Index v) {
    const IntRange faces = facesAround(graph, v);
    return std::any_of(faces.begin(), faces.end(), [&](int f) { return folded[f]; });
  });
}

void relaxStuck(const MeshGraph& graph, const std::vector<char>& free, const Positions& move, Positions& x, int threads)
{
  relaxWhere(graph, free, x, threads, [&](Index v) { return move.col(v).squaredNorm() == 0.0; });
}

Index unfold(const MeshGraph& graph, const Positions& start, const std::vector<char>& free, Positions& x, int threads)
{
  const std::vector<char> before = foldedFaces(graph, start, threads);
  for (int round = 0; round < relaxations; ++round)
    relaxFolds(graph, free, x, threads);
  std::vector<char> times(graph.vertexCount(), 0), touched(graph.vertexCount());
  for (bool again = true; again;) {
    again = false;
    std::fill(touched.begin(), touched.end(), char{0});
    const std::vector<char> now = foldedFaces(graph, x, threads);
    for (Index f = 0; f < graph.faceCount(); ++f)
      if (now[f] && !before[f])
        again |= touchFolded(graph, f, times, touched);
    parallelFor(graph.vertexCount(), threads, [&](Index v) {
      if (touched[v])
        x.col(v) = ++times[v] > halvings ? start.col(v).eval() : (0.5 * (start.col(v) + x.col(v))).eval();
    });
  }
  return graph.vertexCount() - std::count(times.begin(), times.end(), char{0});
}
} // namespace fresco::optimization
