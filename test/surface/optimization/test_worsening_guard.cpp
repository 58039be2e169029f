// SPDX-License-Identifier: BSD-3-Clause
// Optimisation leaves no part of a surface farther from its points than it was.
#include "common/shapes.h"
#include "optimization/common/worsening_guard.h"
#include "surface/optimization/optimization_shapes.h"
#include <fresco/search/triangle_tree.h>
#include <gtest/gtest.h>
using namespace fresco::optimization;
namespace fresco {
namespace {
struct Fit {
  double before = 0, after = 0, count = 0; // sums of distances
};

// Of the points by cubes of the space, `size` wide.
std::map<std::tuple<int, int, int>, Fit> patchFits(const TriangleMesh& before, const TriangleMesh& after,
                                                   const PointSet& points, float size)
{
  const Eigen::Matrix3Xd queries = points.points.cast<double>();
  const auto near_before = closestPoints(TriangleTree(before), queries),
             near_after = closestPoints(TriangleTree(after), queries);
  std::map<std::tuple<int, int, int>, Fit> patches;
  for (Index i = 0; i < points.size(); ++i) {
    const Eigen::Vector3i cube = (points.points.col(i) / size).array().floor().cast<int>();
    Fit& fit = patches[{cube[0], cube[1], cube[2]}];
    fit.before += near_before[i].distance;
    fit.after += near_after[i].distance;
    ++fit.count;
  }
  return patches;
}

// A sphere with dents of about five edges, and points on it.
Points dented(Points on_sphere)
{
  for (Index i = 0; i < on_sphere.cols(); ++i) {
    const Eigen::Array3f wave = (25.f * on_sphere.col(i)).array().sin();
    on_sphere.col(i) *= 1.f + 0.03f * wave.prod();
  }
  return on_sphere;
}

void expectNoPatchWorse(const TriangleMesh& before, const PointSet& points)
{
  constexpr double enough = 30;
  const NormalFilteringResult filtered = filterSurface(before, points);
  const double edge = filtered.edge_length;
  for (const auto& [cube, fit] : patchFits(before, filtered.mesh, points, 8 * edge)) {
    if (fit.count >= enough) {
      // magnitudes of Gaussian values: mean 0.8, deviation 0.6; two deviations of the sum
      const double explained = filtered.noise * (0.8 * fit.count + 1.2 * std::sqrt(fit.count));
      EXPECT_LE(fit.after, 1.1 * std::max(fit.before, explained) + 0.02 * edge * fit.count) << fit.count;
    }
  }
}

TEST(WorseningGuard, NoPatchIsFartherFromItsPoints)
{
  std::mt19937 random(5);
  std::normal_distribution<float> gaussian;
  for (const float noise : {0.f, 0.01f, 0.03f}) {
    TriangleMesh mesh = test::sphere(1.f, 5);
    mesh.vertices = dented(mesh.vertices);
    PointSet points;
    points.points = dented(test::sphere(1.f, 6).vertices);
    for (Index i = 0; i < points.points.size(); ++i)
      points.points.data()[i] += noise * gaussian(random);
    expectNoPatchWorse(mesh, points);
  }
}

// A square of side 20 in the plane z = 0, of two triangles a unit, with its vertices as points where `seen`.
template <typename Seen>
std::pair<TriangleMesh, PointSet> square(const Seen& seen)
{
  constexpr int n = 21;
  TriangleMesh mesh;
  mesh.vertices.setZero(3, n * n);
  mesh.faces.resize(3, 2 * (n - 1) * (n - 1));
  std::vector<Eigen::Vector3f> points;
  Index f = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int v = i * n + j;
      mesh.vertices.col(v) << i, j, 0;
      if (seen(mesh.vertices.col(v)))
        points.push_back(mesh.vertices.col(v));
      if (i + 1 < n && j + 1 < n) {
        mesh.faces.col(f++) << v, v + n, v + n + 1;
        mesh.faces.col(f++) << v, v + n + 1, v + 1;
      }
    }
  PointSet set;
  set.points.resize(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    set.points.col(i) = points[i];
  return {mesh, set};
}

// What the guard leaves of `move` at the middle vertex of `square(seen)`, where the square of side 6 around it moves.
template <typename Seen>
Eigen::Vector3d keptMove(const Seen& seen, const Eigen::Vector3d& move, double noise = 0)
{
  const auto [mesh, points] = square(seen);
  OptimizationProblem problem = makeProblem(mesh, points, 1);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    if ((mesh.vertices.col(v) - Eigen::Vector3f(10, 10, 0)).cwiseAbs().maxCoeff() <= 3.f)
      problem.x.col(v) += move;
  undoWorsening(problem, noise, 1);
  const Index middle = mesh.vertexCount() / 2;
  return problem.x.col(middle) - problem.start.col(middle);
}

TEST(WorseningGuard, VerticesGoBackFromWhereNoPointsAre)
{
  const auto everywhere = [](const Eigen::Vector3f&) { return true; };
  const auto beside = [](const Eigen::Vector3f& p) { return p[0] <= 7.f; };
  const Eigen::Vector3d up(0, 0, 2.5), within(0.1, 0.1, 0);
  EXPECT_LT(keptMove(everywhere, up).norm(), 1e-6);
  EXPECT_LT(keptMove(beside, up).norm(), 1e-6);
  EXPECT_LT((keptMove(everywhere, within) - within).norm(), 1e-6);
}

TEST(WorseningGuard, WhatNoiseExplainsIsNotWorse)
{
  const auto everywhere = [](const Eigen::Vector3f&) { return true; };
  const Eigen::Vector3d up(0, 0, 0.4);
  EXPECT_LT(keptMove(everywhere, up).norm(), 1e-6);
  EXPECT_LT((keptMove(everywhere, up, 0.5) - up).norm(), 1e-6); // 0.8 of it is the mean distance
}

TEST(WorseningGuard, BoundaryMovesAcrossTheSurfaceOnly)
{
  const auto input = square([](const Eigen::Vector3f&) { return true; });
  const TriangleMesh& mesh = input.first;
  OptimizationProblem problem = makeProblem(mesh, input.second, 1);
  problem.start =
      (mesh.vertices.cast<double>().colwise() - problem.frame.center) / problem.frame.unit; // its corners, too
  problem.x = problem.start;
  problem.x.row(0) *= 0.99;
  undoWorsening(problem, 0, 1);
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    const auto at = [&](int k) { return mesh.vertices(k, v) == 0.f || mesh.vertices(k, v) == 20.f; };
    if (at(0) && !at(1)) {
      EXPECT_NEAR(problem.x(0, v), problem.start(0, v), 1e-9);
    }
  }
}
} // namespace
} // namespace fresco
