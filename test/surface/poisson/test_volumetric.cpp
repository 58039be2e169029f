// SPDX-License-Identifier: BSD-3-Clause
#include "surface/poisson/volumetric_shapes.h"
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <limits>
namespace fresco::test {
namespace {
TEST(Volumetric, SphereConvergesWithDepth)
{
  const PointSet points = sphere(40000);
  double before = 1;
  for (const int depth : {4, 5, 6}) {
    const VolumetricResult result = reconstructVolumetric(points, atDepth(depth));
    const MeshTopology topology = meshTopology(result.mesh);
    const double cell = 2.0 * 1.1 / (1 << depth);
    EXPECT_NEAR(result.cell_size, cell, 1e-3 * cell);
    EXPECT_TRUE(topology.watertight) << depth;
    EXPECT_EQ(topology.euler, 2) << depth;
    EXPECT_LT(maxDistance(result.mesh, sphereDistance), 0.3 * cell) << depth;
    const double mean = meanDistance(result.mesh, sphereDistance);
    EXPECT_LT(mean, 0.6 * before) << depth;
    before = mean;
    EXPECT_NEAR(signedVolume(result.mesh), 4 * pi / 3, 4 * pi * 0.1 * cell) << depth;
  }
}

TEST(Volumetric, TorusHasOneHandle)
{
  const double tube = 0.35;
  const PointSet points = torus(30000, tube, 3);
  for (const int depth : {5, 6}) {
    const VolumetricResult result = reconstructVolumetric(points, atDepth(depth));
    const MeshTopology topology = meshTopology(result.mesh);
    EXPECT_TRUE(topology.watertight);
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.euler, 0);
    EXPECT_NEAR(signedVolume(result.mesh), 2 * pi * pi * tube * tube, 0.02);
    const auto distance = [&](const Eigen::Vector3d& p) {
      return std::hypot(std::hypot(p.x(), p.y()) - 1, p.z()) - tube;
    };
    EXPECT_LT(maxDistance(result.mesh, distance), 0.5 * result.cell_size);
  }
}

TEST(Volumetric, BoxConvergesWithDepth)
{
  const PointSet points = box(200000, 5);
  double before = 1;
  for (const int depth : {4, 5, 6}) {
    const VolumetricResult result = reconstructVolumetric(points, atDepth(depth));
    EXPECT_TRUE(meshTopology(result.mesh).watertight);
    EXPECT_EQ(meshTopology(result.mesh).euler, 2);
    EXPECT_LT(maxDistance(result.mesh, boxDistance), 1.2 * result.cell_size);
    const double mean = meanDistance(result.mesh, boxDistance);
    EXPECT_LT(mean, 0.8 * before);
    before = mean;
    EXPECT_NEAR(signedVolume(result.mesh), 8, result.cell_size);
  }
}

TEST(Volumetric, FlippedNormalsTurnTheSurfaceInsideOut)
{
  PointSet points = sphere(5000);
  points.normals *= -1;
  const TriangleMesh mesh = reconstructVolumetric(points, atDepth(5)).mesh;
  EXPECT_TRUE(meshTopology(mesh).watertight);
  EXPECT_NEAR(signedVolume(mesh), -4 * pi / 3, 0.1);
}

TEST(Volumetric, AnyNumberOfThreadsGivesTheSameBits)
{
  PointSet points = torus(30000, 0.3, 7);
  points.colors = (points.normals.array() * 127.f + 128.f).cast<std::uint8_t>();
  VolumetricOptions options = atDepth(7);
  options.threads = 1;
  const VolumetricResult one = reconstructVolumetric(points, options);
  options.threads = 4;
  const VolumetricResult four = reconstructVolumetric(points, options);
  EXPECT_EQ(one.mesh.vertices, four.mesh.vertices);
  EXPECT_EQ(one.mesh.faces, four.mesh.faces);
  EXPECT_EQ(one.mesh.colors, four.mesh.colors);
  EXPECT_EQ(one.mesh.fields.at("support"), four.mesh.fields.at("support"));
  EXPECT_EQ(one.residual, four.residual);
}

TEST(Volumetric, OrderOfThePointsDoesNotMatter)
{
  const PointSet points = sphere(8000);
  std::vector<Index> order(8000);
  for (Index i = 0; i < 8000; ++i)
    order[i] = (i * 4801) % 8000;
  const TriangleMesh a = reconstructVolumetric(points, atDepth(5)).mesh;
  const TriangleMesh b = reconstructVolumetric(selectPoints(points, order), atDepth(5)).mesh;
  ASSERT_EQ(a.vertexCount(), b.vertexCount());
  EXPECT_LT((a.vertices - b.vertices).cwiseAbs().maxCoeff(), 1e-4f);
}

TEST(Volumetric, MovedPointsGiveTheMovedSurface)
{
  const PointSet points = torus(20000, 0.4, 2);
  const TriangleMesh mesh = reconstructVolumetric(points, atDepth(6)).mesh;
  PointSet moved = points;
  moved.points = (points.points * 0.01f).colwise() + Eigen::Vector3f(2.f, -3.f, 5.f);
  const TriangleMesh other = reconstructVolumetric(moved, atDepth(6)).mesh;
  // The cube moves and scales along, but for rounding.
  EXPECT_NEAR(static_cast<double>(other.vertexCount()), static_cast<double>(mesh.vertexCount()),
              0.002 * static_cast<double>(mesh.vertexCount()));
  EXPECT_NEAR(signedVolume(other), 1e-6 * signedVolume(mesh), 1e-9);
  EXPECT_EQ(meshTopology(other).euler, 0);
  // A rotation gives another grid: the same surface within a fraction of a cell.
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.7f, Eigen::Vector3f(1, 2, 3).normalized()).toRotationMatrix();
  moved.points = turn * points.points;
  moved.normals = turn * points.normals;
  const VolumetricResult turned = reconstructVolumetric(moved, atDepth(6));
  EXPECT_EQ(meshTopology(turned.mesh).euler, 0);
  EXPECT_NEAR(signedVolume(turned.mesh), signedVolume(mesh), 0.03);
}

TEST(Volumetric, LargeCoordinatesGoThroughTheOrigin)
{
  PointSet points = sphere(5000);
  const TriangleMesh mesh = reconstructVolumetric(points, atDepth(5)).mesh;
  points.origin = Eigen::Vector3d(4.5e5, 5.4e6, 300);
  const TriangleMesh far = reconstructVolumetric(points, atDepth(5)).mesh;
  EXPECT_EQ(far.origin, points.origin);
  EXPECT_EQ(far.vertices, mesh.vertices);
}

TEST(Volumetric, CellSizeSetsTheDepth)
{
  const PointSet points = sphere(5000);
  VolumetricOptions options;
  options.cell_size = 0.05;
  const VolumetricResult result = reconstructVolumetric(points, options);
  EXPECT_EQ(result.depth, 6); // 2.2 / 0.05 = 44 cells fit into 64
  EXPECT_NEAR(result.cell_size, 0.05, 1e-12);
  options.cell_size = 1e-9;
  EXPECT_THROW(reconstructVolumetric(points, options), std::invalid_argument);
}

TEST(Volumetric, ResidualFallsWithIterations)
{
  const PointSet points = torus(20000, 0.4, 4);
  double before = std::numeric_limits<double>::infinity();
  for (const int iterations : {2, 8, 32, 128}) {
    VolumetricOptions options = atDepth(6);
    options.iterations = iterations;
    const double residual = reconstructVolumetric(points, options).residual;
    EXPECT_LT(residual, before);
    before = residual;
  }
  EXPECT_LT(before, 1e-4);
}

TEST(Volumetric, ScreeningPullsTheSurfaceTowardsThePoints)
{
  const PointSet points = box(20000, 9);
  const auto errorWith = [&](float weight) {
    VolumetricOptions options = atDepth(6);
    options.point_weight = weight;
    const VolumetricResult result = reconstructVolumetric(points, options);
    EXPECT_TRUE(meshTopology(result.mesh).watertight) << weight;
    EXPECT_EQ(meshTopology(result.mesh).euler, 2) << weight;
    return meanDistance(result.mesh, boxDistance);
  };
  const double unscreened = errorWith(0.f), weak = errorWith(0.5f), strong = errorWith(8.f);
  EXPECT_LT(weak, unscreened);
  EXPECT_LT(strong, weak);
}

TEST(Volumetric, DenseExactPointsHoldCreasesTighter)
{
  const auto errorOf = [](Index count) {
    const VolumetricResult result = reconstructVolumetric(box(count, 9), atDepth(6));
    EXPECT_EQ(meshTopology(result.mesh).euler, 2) << count;
    return meanDistance(result.mesh, boxDistance);
  };
  EXPECT_LT(errorOf(80000), 0.7 * errorOf(20000)); // 4 and 1 a face of a cell
}

TEST(Volumetric, DensityThatDiffersFiftyfoldTearsNothing)
{
  const PointSet dense = sphere(200000);
  std::vector<Index> kept;
  for (Index i = 0; i < dense.size(); ++i)
    if (dense.points(2, i) > 0 || i % 50 == 0)
      kept.push_back(i);
  const PointSet points = selectPoints(dense, kept);
  for (const int depth : {6, 8}) {
    const VolumetricResult result = reconstructVolumetric(points, atDepth(depth));
    const MeshTopology topology = meshTopology(result.mesh);
    EXPECT_TRUE(topology.watertight) << depth;
    EXPECT_EQ(topology.components, 1) << depth;
    EXPECT_EQ(topology.euler, 2) << depth;
    EXPECT_LT(maxDistance(result.mesh, sphereDistance), 0.02) << depth;
    const Eigen::VectorXf& support = result.mesh.fields.at("support");
    double upper = 0, lower = 0, upper_count = 0, lower_count = 0;
    for (Index v = 0; v < result.mesh.vertexCount(); ++v) {
      const bool up = result.mesh.vertices(2, v) > 0.1f, down = result.mesh.vertices(2, v) < -0.1f;
      upper += up ? support[v] : 0;
      lower += down ? support[v] : 0;
      upper_count += up;
      lower_count += down;
    }
    EXPECT_NEAR(upper / upper_count - lower / lower_count, std::log(50.0) / std::log(4.0), 0.2) << depth;
  }
}
} // namespace
} // namespace fresco::test
