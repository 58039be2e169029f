// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/inversion_guard.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
using Eigen::Vector3d;

constexpr int halvings = 5; // of a move before it is given up: what is left of it, 3 %, is below what a step gains

Vector3d movedAreaVector(const MeshGraph& graph, const Positions& x, const Positions& move, Index f)
{
  Vector3d corner[3];
  for (int k = 0; k < 3; ++k)
    corner[k] = x.col(graph.faces(k, f)) + move.col(graph.faces(k, f));
  return (corner[1] - corner[0]).cross(corner[2] - corner[0]);
}

bool isInvertedBy(const MeshGraph& graph, const Positions& x, const Positions& move, const Vector3d& normal, Index f)
{
  constexpr double least_area = 1e-4; // squared mean edge lengths: the area vector of a needle below is mostly rounding
  if (graph.face_edges(0, f) < 0 || normal.squaredNorm() == 0.0)
    return false;
  const double after = movedAreaVector(graph, x, move, f).dot(normal);
  return after < least_area && after < areaVector(graph, x, f).dot(normal);
}

// Marks the corners of an inverted face that can still be moved back, and where there is none, the ring around it: with
// all of that at the start the face cannot be inverted. False if everything is there already.
bool touchInverted(const MeshGraph& graph, Index f, const std::vector<char>& times, std::vector<char>& touched)
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
    if (free[v] && !graph.border[v] && edgesAround(graph, v).size() > 0 && which(v))
      x.col(v) = meanOfNeighbours(graph, before, v);
  });
}
} // namespace

void limitMoves(const MeshGraph& graph, const Positions& x, const Eigen::Matrix3Xf& normals, Positions& move,
                int threads)
{
  constexpr int limit_rounds = 40; // a vertex given up can invert a face of its neighbours, but not for long
  std::vector<char> inverted(graph.faceCount()), times(graph.vertexCount(), 0);
  for (int round = 0; round < limit_rounds; ++round) {
    const Index count = parallelSum(graph.faceCount(), threads, Index{0}, [&](Index f) -> Index {
      inverted[f] = isInvertedBy(graph, x, move, normals.col(f).cast<double>(), f) ? 1 : 0;
      return inverted[f];
    });
    if (count == 0)
      return;
    parallelFor(graph.vertexCount(), threads, [&](Index v) {
      for (const int f : facesAround(graph, v))
        if (inverted[f]) {
          move.col(v) *= ++times[v] > halvings ? 0.0 : 0.5;
          times[v] = std::min<char>(times[v], halvings);
          return;
        }
    });
  }
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    for (const int f : facesAround(graph, v))
      if (inverted[f])
        move.col(v).setZero();
  });
}

std::vector<char> invertedFaces(const MeshGraph& graph, const Positions& x, int threads)
{
  const Eigen::Matrix3Xd areas = areaVectors(graph, x, threads);
  Positions around = Positions::Zero(3, graph.vertexCount());
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    for (const int f : facesAround(graph, v))
      around.col(v) += areas.col(f);
  });
  std::vector<char> inverted(graph.faceCount(), 0);
  parallelFor(graph.faceCount(), threads, [&](Index f) {
    if (graph.face_edges(0, f) < 0)
      return;
    Vector3d mean = Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      mean += around.col(graph.faces(k, f));
    inverted[f] = areas.col(f).dot(mean) < 0.0 ? 1 : 0;
  });
  return inverted;
}

void relaxInverted(const MeshGraph& graph, const std::vector<char>& free, Positions& x, int threads)
{
  const std::vector<char> inverted = invertedFaces(graph, x, threads);
  relaxWhere(graph, free, x, threads, [&](Index v) {
    const IntRange faces = facesAround(graph, v);
    return std::any_of(faces.begin(), faces.end(), [&](int f) { return inverted[f]; });
  });
}

void relaxStuck(const MeshGraph& graph, const std::vector<char>& free, const Positions& move, Positions& x, int threads)
{
  relaxWhere(graph, free, x, threads, [&](Index v) { return move.col(v).squaredNorm() == 0.0; });
}

Index repairInverted(const MeshGraph& graph, const Positions& start, const std::vector<char>& free, Positions& x,
                     int threads)
{
  constexpr int relaxations = 3; // each reaches one ring farther; what is inverted over a wider part goes back
  const std::vector<char> before = invertedFaces(graph, start, threads);
  for (int round = 0; round < relaxations; ++round)
    relaxInverted(graph, free, x, threads);
  std::vector<char> times(graph.vertexCount(), 0), touched(graph.vertexCount());
  for (bool again = true; again;) {
    again = false;
    std::fill(touched.begin(), touched.end(), char{0});
    const std::vector<char> now = invertedFaces(graph, x, threads);
    for (Index f = 0; f < graph.faceCount(); ++f)
      if (now[f] && !before[f])
        again |= touchInverted(graph, f, times, touched);
    parallelFor(graph.vertexCount(), threads, [&](Index v) {
      if (touched[v])
        x.col(v) = ++times[v] > halvings ? start.col(v).eval() : (0.5 * (start.col(v) + x.col(v))).eval();
    });
  }
  return graph.vertexCount() - std::count(times.begin(), times.end(), char{0});
}
} // namespace fresco::optimization
