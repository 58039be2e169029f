// SPDX-License-Identifier: BSD-3-Clause
// The boundary of an optimised surface is a smooth curve, and it stays where it was.
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/surface/core/mesh_trimming.h>
#include <fresco/surface/core/normal_filtering.h>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <utility>
#include <vector>
namespace fresco {
namespace {
constexpr float radius = 15.f; // edges of the grid

/// A disc of a grid in the plane z = 0, cut along a noisy line out of a noisy surface, and noisy points of the plane.
std::pair<TriangleMesh, PointSet> raggedDisc(float noise)
{
  constexpr int n = 41;
  std::mt19937 random(7);
  std::normal_distribution<float> gaussian(0.f, 1.f);
  TriangleMesh mesh;
  mesh.vertices.resize(3, n * n);
  mesh.faces.resize(3, 2 * (n - 1) * (n - 1));
  Eigen::VectorXf inside(n * n);
  Index f = 0;
  for (int i = 0; i < n * n; ++i) {
    mesh.vertices.col(i) << i % n - n / 2, i / n - n / 2, 0.1f * gaussian(random);
    inside[i] = radius - mesh.vertices.col(i).head<2>().norm() + noise * gaussian(random);
    if (i % n < n - 1 && i / n < n - 1) {
      mesh.faces.col(f++) << i, i + 1, i + n + 1;
      mesh.faces.col(f++) << i, i + n + 1, i + n;
    }
  }
  PointSet points;
  points.points.resize(3, n * n); // 0.65 edges apart
  for (Index i = 0; i < points.points.cols(); ++i) {
    const float r = radius * std::sqrt((i + 0.5f) / points.points.cols()), angle = 2.399963f * i; // a sunflower
    points.points.col(i) << r * std::cos(angle), r * std::sin(angle), 0.02f * gaussian(random);
  }
  return {trimMesh(mesh, inside, {0.f, 100.0, 100.0, 0}), points};
}

struct Rim {
  double length = 0, radius = 0; ///< of the boundary edges; of their middles, mean by length
};

Rim rimOf(const TriangleMesh& mesh)
{
  std::map<std::pair<int, int>, int> sides;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k)
      ++sides[std::minmax({mesh.faces(k, f), mesh.faces((k + 1) % 3, f)})];
  Rim rim;
  for (const auto& [ends, count] : sides)
    if (count == 1) {
      const Eigen::Vector3f a = mesh.vertices.col(ends.first), b = mesh.vertices.col(ends.second);
      rim.length += (a - b).norm();
      rim.radius += (a - b).norm() * (0.5f * (a + b)).norm();
    }
  rim.radius /= rim.length;
  return rim;
}

TEST(Boundary, OfARaggedDiscBecomesACircleThatDoesNotShrink)
{
  const auto [mesh, points] = raggedDisc(0.5f);
  const TriangleMesh smooth = filterSurface(mesh, points).mesh;
  const Rim before = rimOf(mesh), after = rimOf(smooth);
  EXPECT_GT(before.length, 1.2 * 2 * pi * radius);
  EXPECT_LT(after.length, 1.08 * 2 * pi * radius);
  EXPECT_NEAR(after.radius, before.radius, 0.1);
  EXPECT_NEAR(surfaceArea(smooth), pi * radius * radius, 0.01 * pi * radius * radius);
  for (Index f = 0; f < smooth.faceCount(); ++f)
    EXPECT_GE(areaVector(smooth, f).z(), 0) << f;
}

TEST(Boundary, StaysWhereItIsSmooth)
{
  const auto [mesh, points] = raggedDisc(0.f);
  const TriangleMesh same = filterSurface(mesh, points).mesh;
  EXPECT_NEAR(rimOf(same).radius, rimOf(mesh).radius, 0.02);
  EXPECT_NEAR(rimOf(same).length, 2 * pi * radius, 0.01 * 2 * pi * radius);
  EXPECT_NEAR(surfaceArea(same), pi * radius * radius, 0.003 * pi * radius * radius);
}

// A square whose data are closer than its vertices has sharp corners as long as the data say so.
TEST(Boundary, MovesNoFartherThanDataAreApart)
{
  constexpr int n = 21;
  TriangleMesh square;
  square.vertices.resize(3, n * n);
  for (int i = 0; i < n * n; ++i)
    square.vertices.col(i) << i % n, i / n, 0;
  std::vector<Eigen::Vector3i> faces;
  for (int i = 0; i < n * (n - 1); ++i)
    if (i % n < n - 1)
      for (const Eigen::Vector3i& face : {Eigen::Vector3i(i, i + 1, i + n + 1), Eigen::Vector3i(i, i + n + 1, i + n)})
        faces.push_back(face);
  square.faces = Eigen::Map<const Eigen::Matrix3Xi>(faces[0].data(), 3, faces.size());
  std::vector<double> moved;
  for (const int per_edge : {1, 5}) {
    const int side = per_edge * (n - 1);
    PointSet points;
    points.points.resize(3, side * side);
    for (int i = 0; i < side * side; ++i)
      points.points.col(i) << (i % side + 0.5f) / per_edge, (i / side + 0.5f) / per_edge, 0;
    const TriangleMesh smooth = filterSurface(square, points).mesh;
    moved.push_back((smooth.vertices - square.vertices).colwise().norm().maxCoeff());
    EXPECT_LT(moved.back(), 1.5 / per_edge);
  }
  EXPECT_GT(moved[0], 0.4);
}

TEST(Boundary, SameBitsForAnyNumberOfThreads)
{
  const auto [mesh, points] = raggedDisc(0.5f);
  NormalFilteringOptions options;
  options.threads = 1;
  const TriangleMesh once = filterSurface(mesh, points, options).mesh;
  options.threads = 4;
  EXPECT_EQ(once.vertices, filterSurface(mesh, points, options).mesh.vertices);
}
} // namespace
} // namespace fresco
