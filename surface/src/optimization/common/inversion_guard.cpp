// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/inversion_guard.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <utility>
namespace fresco::optimization {
namespace {
using Eigen::Vector3d;

// How much of `move` face f can take: all, or up to where nearly nothing is left of its area.
double partAllowed(const MeshGraph& graph, const Positions& x, const Positions& move, const Vector3d& normal, Index f)
{
  constexpr double least_share = 0.1; // is left of a face; what is small or inverted may lose half of a small area more
  const auto corner = [&](const Positions& of, int k) -> Vector3d { return of.col(graph.faces(k, f)); };
  const Vector3d e1 = corner(x, 1) - corner(x, 0), e2 = corner(x, 2) - corner(x, 0),
                 m1 = corner(move, 1) - corner(move, 0), m2 = corner(move, 2) - corner(move, 0);
  // The area along the normal after the part t of the move: before + linear t + square t^2. A positive square is left
  // out: whether the area comes back before it is gone would be decided at once.
  const double before = e1.cross(e2).dot(normal), linear = (e1.cross(m2) + m1.cross(e2)).dot(normal),
               square = std::min(0.0, m1.cross(m2).dot(normal));
  const double most_lost = before - std::min(least_share * before, before - 0.5 * small_area);
  // The least t > 0 with linear t + square t^2 = -most_lost, in a form without cancellation.
  const double denominator = -linear + std::sqrt(linear * linear - 4.0 * square * most_lost);
  return denominator > 2.0 * most_lost ? 2.0 * most_lost / denominator : 1.0;
}

// Sum of the areas of the faces around the corners of face f.
Vector3d areaAround(const MeshGraph& graph, const Positions& x, Index f)
{
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    for (const int g : facesAround(graph, graph.faces(k, f)))
      sum += areaVector(graph, x, g);
  return sum;
}

// The least part of the way back to the start after which inverted face f faces as those around it do now; 1 if none.
double leastWayBack(const MeshGraph& graph, const Positions& start, const Positions& x, Index f)
{
  const Vector3d mean = areaAround(graph, x, f);
  const auto edge = [&](const Positions& of, int k) -> Vector3d {
    return of.col(graph.faces(k, f)) - of.col(graph.faces(0, f));
  };
  const Vector3d e1 = edge(x, 1), e2 = edge(x, 2), d1 = edge(start, 1) - e1, d2 = edge(start, 2) - e2;
  // area + linear t + square t^2 = 0 from area < 0 on, in a form without cancellation.
  const double area = e1.cross(e2).dot(mean), linear = (e1.cross(d2) + d1.cross(e2)).dot(mean),
               square = d1.cross(d2).dot(mean), inside = linear * linear - 4.0 * square * area;
  const double denominator = linear + std::sqrt(std::max(0.0, inside));
  return inside >= 0.0 && denominator > -2.0 * area ? std::max(0.0, -2.0 * area / denominator) : 1.0;
}

// Numbers below a limit, each once, in the order in which they came.
class NumberSet {
public:
  explicit NumberSet(Index limit) : here_(limit, 0) {}
  void add(int number)
  {
    if (!here_[number])
      numbers_.push_back(number);
    here_[number] = 1;
  }
  void clear()
  {
    for (const int number : numbers_)
      here_[number] = 0;
    numbers_.clear();
  }
  const std::vector<int>& numbers() const { return numbers_; }

private:
  std::vector<char> here_;
  std::vector<int> numbers_;
};

// Faces that are inverted at x and were not so before: of all, then of those near the last ones.
class NewlyInverted {
public:
  NewlyInverted(const MeshGraph& graph, const std::vector<char>& before, int threads)
      : graph_(graph), before_(before), threads_(threads), near_(graph.faceCount())
  {}

  const std::vector<int>& findAll(const Positions& x)
  {
    const std::vector<char> now = invertedFaces(graph_, x, threads_);
    found_.clear();
    for (Index f = 0; f < graph_.faceCount(); ++f)
      if (now[f] && !before_[f])
        found_.push_back(static_cast<int>(f));
    return found_;
  }

  // Where only corners of the last ones have moved, or those of the faces around them.
  const std::vector<int>& findAgain(const Positions& x)
  {
    constexpr int rings = 3; // of faces that depend on what has moved
    near_.clear();
    for (const int f : found_)
      near_.add(f);
    for (int ring = 0; ring < rings; ++ring)
      for (const int f : std::vector<int>(near_.numbers()))
        for (int k = 0; k < 3; ++k)
          for (const int g : facesAround(graph_, graph_.faces(k, f)))
            near_.add(g);
    found_.clear();
    for (const int f : near_.numbers())
      if (!before_[f] && areaVector(graph_, x, f).dot(areaAround(graph_, x, f)) < 0.0)
        found_.push_back(f);
    std::sort(found_.begin(), found_.end());
    return found_;
  }

private:
  const MeshGraph& graph_;
  const std::vector<char>& before_;
  int threads_;
  NumberSet near_;
  std::vector<int> found_;
};

// Puts the corners of inverted faces back to the start, and where they are there, the ring around them: with all of
// that at the start a face cannot be inverted.
void putBack(const MeshGraph& graph, const Positions& start, NewlyInverted& inverted, Positions& x)
{
  const auto put = [&](Index v) {
    const bool away = x.col(v) != start.col(v);
    x.col(v) = start.col(v);
    return away;
  };
  std::vector<int> faces = inverted.findAll(x);
  for (bool any = true; any; faces = inverted.findAgain(x)) {
    any = false;
    for (const int f : faces) {
      bool corners = false;
      for (int k = 0; k < 3; ++k)
        corners |= put(graph.faces(k, f));
      any |= corners;
      for (int k = 0; k < 3 && !corners; ++k)
        for (const int g : facesAround(graph, graph.faces(k, f)))
          for (int j = 0; j < 3; ++j)
            any |= put(graph.faces(j, g));
    }
  }
}

// Vertices inside the surface go to the middle of their neighbours, the share(v) of the way.
template <typename Share>
void relaxBy(const MeshGraph& graph, Positions& x, int threads, const Share& share)
{
  const Positions before = x;
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    if (graph.border[v] || edgesAround(graph, v).size() == 0)
      return;
    if (const double way = share(v); way > 0.0)
      x.col(v) += way * (meanOfNeighbours(graph, before, v) - before.col(v));
  });
}

// F, cosine of the angle between each face and the area-weighted mean of the faces around its corners, nearer to 0 the
// smaller the face.
Eigen::VectorXd facing(const MeshGraph& graph, const Positions& x, int threads)
{
  const Eigen::Matrix3Xd areas = areaVectors(graph, x, threads);
  Positions around = Positions::Zero(3, graph.vertexCount());
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    for (const int f : facesAround(graph, v))
      around.col(v) += areas.col(f);
  });
  Eigen::VectorXd cosines(graph.faceCount());
  parallelFor(graph.faceCount(), threads, [&](Index f) {
    Vector3d mean = Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      mean += around.col(graph.faces(k, f));
    const double lengths = (areas.col(f).norm() + 3.0 * small_area) * mean.norm();
    cosines[f] = graph.face_edges(0, f) < 0 || !(lengths > 0.0) ? 1.0 : areas.col(f).dot(mean) / lengths;
  });
  return cosines;
}
} // namespace

Eigen::VectorXf limitMoves(const MeshGraph& graph, const Positions& x, const Eigen::Matrix3Xf& normals, Positions& move,
                           int threads)
{
  constexpr int most_rounds = 40; // a vertex held back can invert a face of its neighbours, but not for long
  constexpr double all = 1.0 - 1e-6;
  Eigen::VectorXf left = Eigen::VectorXf::Ones(graph.vertexCount());
  Eigen::VectorXd part = Eigen::VectorXd::Ones(graph.faceCount());
  const auto allow = [&](int f) {
    const Vector3d normal = normals.col(f).cast<double>();
    part[f] = graph.face_edges(0, f) < 0 || normal.isZero(0.0) ? 1.0 : partAllowed(graph, x, move, normal, f);
  };
  parallelFor(graph.faceCount(), threads, allow);
  NumberSet faces(graph.faceCount()), held(graph.vertexCount());
  for (int f = 0; f < graph.faceCount(); ++f)
    if (part[f] < 1.0)
      faces.add(f);
  for (int round = 0; round < most_rounds; ++round) {
    if (std::all_of(faces.numbers().begin(), faces.numbers().end(), [&](int f) { return part[f] >= all; }))
      break;
    held.clear();
    for (const int f : faces.numbers())
      for (int k = 0; k < 3 && part[f] < 1.0; ++k)
        held.add(graph.faces(k, f));
    parallelFor(held.numbers().size(), threads, [&](Index i) {
      const int v = held.numbers()[i];
      double least = 1.0;
      for (const int f : facesAround(graph, v))
        least = std::min(least, part[f]);
      move.col(v) *= least;
      left[v] *= static_cast<float>(least);
    });
    // Only the faces around vertices whose moves became shorter can allow less than they did.
    faces.clear();
    for (const int v : held.numbers())
      for (const int f : facesAround(graph, v))
        faces.add(f);
    parallelFor(faces.numbers().size(), threads, [&](Index i) { allow(faces.numbers()[i]); });
  }
  return left;
}

std::vector<char> invertedFaces(const MeshGraph& graph, const Positions& x, int threads)
{
  const Eigen::VectorXd cosines = facing(graph, x, threads);
  std::vector<char> inverted(graph.faceCount());
  for (Index f = 0; f < graph.faceCount(); ++f)
    inverted[f] = cosines[f] < 0.0 ? 1 : 0;
  return inverted;
}

void relaxInverted(const MeshGraph& graph, const Eigen::VectorXf& part, Positions& x, int threads)
{
  constexpr double inverted = -0.4; // from 90 degrees to here the way grows from nothing to all
  const Eigen::VectorXd cosines = facing(graph, x, threads);
  relaxBy(graph, x, threads, [&](Index v) {
    double least = 1.0;
    for (const int f : facesAround(graph, v))
      least = std::min(least, cosines[f]);
    return part[v] * ramp(least, 0.0, inverted);
  });
}

void relaxStuck(const MeshGraph& graph, const Eigen::VectorXf& part, const Eigen::VectorXf& left, Positions& x,
                int threads)
{
  constexpr double hardly = 0.05; // of a move: what is left of it gains nothing
  relaxBy(graph, x, threads, [&](Index v) { return part[v] * ramp(left[v], hardly, 0.0); });
}

Index repairInverted(const MeshGraph& graph, const Positions& start, const Eigen::VectorXf& part, Positions& x,
                     int threads)
{
  constexpr int relaxations = 3, rounds = 20; // each reaches one ring farther; few faces are left after five rounds
  constexpr double farther = 1.25;            // than needed, so that rounds come to an end
  const std::vector<char> before = invertedFaces(graph, start, threads);
  for (int round = 0; round < relaxations; ++round)
    relaxInverted(graph, part, x, threads);
  const Positions relaxed = x;
  Eigen::VectorXd back = Eigen::VectorXd::Zero(graph.vertexCount());
  NewlyInverted inverted(graph, before, threads);
  std::vector<int> faces = inverted.findAll(x);
  for (int round = 0; round < rounds && !faces.empty(); ++round) {
    for (const int f : faces) {
      const double way = std::min(1.0, farther * leastWayBack(graph, start, x, f));
      for (int k = 0; k < 3; ++k)
        back[graph.faces(k, f)] = std::max(back[graph.faces(k, f)], way);
    }
    for (const int f : faces)
      for (int k = 0; k < 3; ++k) {
        const int v = graph.faces(k, f);
        x.col(v) += std::exchange(back[v], 0.0) * (start.col(v) - x.col(v));
      }
    faces = inverted.findAgain(x);
  }
  putBack(graph, start, inverted, x);
  return (x.array() != relaxed.array()).colwise().any().count();
}
} // namespace fresco::optimization
