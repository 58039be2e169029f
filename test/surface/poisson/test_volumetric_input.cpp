// SPDX-License-Identifier: BSD-3-Clause
#include "surface/poisson/volumetric_shapes.h"
#include <fresco/surface/core/mesh_trimming.h>
#include <gtest/gtest.h>
#include <limits>
namespace fresco::test {
namespace {
constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();

void expectRejected(const PointSet& points, const VolumetricOptions& options = atDepth(5))
{
  EXPECT_THROW(reconstructVolumetric(points, options), std::invalid_argument);
  EXPECT_THROW(estimateMemory(points, options), std::invalid_argument);
}

PointSet several(Index count, const PointSet& source)
{
  PointSet set;
  set.points = source.points.leftCols(count);
  set.normals = source.normals.leftCols(count);
  return set;
}

TEST(VolumetricInput, UnusablePointsAreLeftOutAndCounted)
{
  const PointSet clean = sphere(5000);
  PointSet points = sphere(5006);
  points.points.rightCols(5000) = clean.points;
  points.normals.rightCols(5000) = clean.normals;
  points.points(0, 0) = nan;
  points.points(1, 1) = inf;
  points.normals(2, 2) = nan;
  points.normals.col(3).setZero();
  points.normals(0, 4) = inf;
  points.points.col(5) << 1000.f, 0.f, 0.f; // a far outlier
  const VolumetricResult expected = reconstructVolumetric(clean, atDepth(5));
  const VolumetricResult result = reconstructVolumetric(points, atDepth(5));
  EXPECT_EQ(result.left_out_points, 6);
  EXPECT_EQ(result.used_points, 5000);
  EXPECT_EQ(result.mesh.vertices, expected.mesh.vertices);
  EXPECT_EQ(result.mesh.faces, expected.mesh.faces);
}

TEST(VolumetricInput, TooFewPointsAreAnError)
{
  const PointSet all = sphere(10);
  expectRejected(PointSet{});
  for (const Index n : {0, 1, 2, 3})
    expectRejected(several(n, all));
  PointSet points = several(10, all);
  points.normals.resize(3, 0);
  expectRejected(points);
  points = several(10, all);
  points.normals.setZero();
  expectRejected(points);
  points = several(10, all);
  points.points.setConstant(nan);
  expectRejected(points);
  points = several(10, all);
  points.points.setConstant(3.5f);
  expectRejected(points);
  points = several(10, all);
  points.normals.conservativeResize(3, 9);
  expectRejected(points);
}

TEST(VolumetricInput, FewOrFlatPointsGiveAClosedMeshOrNone)
{
  for (const Index n : {4, 5, 20}) {
    const VolumetricResult result = reconstructVolumetric(sphere(n), atDepth(5));
    EXPECT_TRUE(result.mesh.faceCount() == 0 || meshTopology(result.mesh).watertight) << n;
  }
  PointSet plane = sphere(3000);
  plane.points.row(2).setZero();
  plane.normals.colwise() = Eigen::Vector3f(0, 0, 1);
  const VolumetricResult flat = reconstructVolumetric(plane, atDepth(6));
  EXPECT_TRUE(meshTopology(flat.mesh).watertight);
  PointSet line = sphere(3000);
  line.points.bottomRows(2).setZero();
  const VolumetricResult thin = reconstructVolumetric(line, atDepth(6));
  EXPECT_TRUE(thin.mesh.faceCount() == 0 || meshTopology(thin.mesh).watertight);
}

TEST(VolumetricInput, OptionsOutOfRangeAreAnError)
{
  const PointSet points = sphere(100);
  const auto reject = [&](auto change) {
    VolumetricOptions options = atDepth(4);
    change(options);
    expectRejected(points, options);
  };
  reject([](VolumetricOptions& o) { o.depth = 1; });
  reject([](VolumetricOptions& o) { o.depth = 17; });
  reject([](VolumetricOptions& o) { o.cell_size = -1; });
  reject([](VolumetricOptions& o) { o.cell_size = nan; });
  reject([](VolumetricOptions& o) { o.min_depth = 1; });
  reject([](VolumetricOptions& o) { o.min_depth = 9; });
  reject([](VolumetricOptions& o) { o.point_weight = -1; });
  reject([](VolumetricOptions& o) { o.point_weight = nan; });
  reject([](VolumetricOptions& o) { o.scale = 0.9f; });
  reject([](VolumetricOptions& o) { o.scale = inf; });
  reject([](VolumetricOptions& o) { o.samples_per_node = 0; });
  reject([](VolumetricOptions& o) { o.trim = -1; });
  reject([](VolumetricOptions& o) { o.trim_levels = -1; });
  reject([](VolumetricOptions& o) { o.iterations = 0; });
  reject([](VolumetricOptions& o) { o.threads = -1; });
}

TEST(VolumetricInput, EveryDepthWorks)
{
  const PointSet points = sphere(2000);
  for (const int depth : {2, 3, 4, 9, 12}) {
    const VolumetricResult result = reconstructVolumetric(points, atDepth(depth));
    EXPECT_TRUE(meshTopology(result.mesh).watertight) << depth;
    EXPECT_EQ(meshTopology(result.mesh).euler, 2) << depth;
    EXPECT_EQ(result.depth, depth);
  }
}

TEST(VolumetricInput, ColorsAndIntensitiesReachTheVertices)
{
  PointSet points = sphere(20000);
  points.colors.resize(3, points.size());
  points.intensities.resize(points.size());
  for (Index i = 0; i < points.size(); ++i) {
    const bool up = points.points(2, i) > 0;
    points.colors.col(i) << (up ? 250 : 10), 100, (up ? 0 : 200);
    points.intensities[i] = points.points(0, i);
  }
  const TriangleMesh mesh = reconstructVolumetric(points, atDepth(6)).mesh;
  ASSERT_EQ(mesh.colors.cols(), mesh.vertexCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_NEAR(mesh.fields.at("intensity")[v], mesh.vertices(0, v), 0.05f);
    EXPECT_EQ(mesh.colors(1, v), 100);
    if (std::abs(mesh.vertices(2, v)) > 0.1f) {
      EXPECT_EQ(mesh.colors(0, v), mesh.vertices(2, v) > 0 ? 250 : 10);
      EXPECT_EQ(mesh.colors(2, v), mesh.vertices(2, v) > 0 ? 0 : 200);
    }
  }
}

TEST(VolumetricInput, ConfidenceMovesTheSurfaceToTheTrustedPoints)
{
  const PointSet inner = sphere(20000);
  PointSet outer = inner;
  outer.points *= 1.04f;
  PointSet points = mergePoints(inner, outer);
  points.normals.leftCols(20000) *= 100.f; // the inner points are trusted
  VolumetricOptions options = atDepth(5);
  const double even = meanDistance(reconstructVolumetric(points, options).mesh, sphereDistance);
  options.confidence = true;
  const double by_length = meanDistance(reconstructVolumetric(points, options).mesh, sphereDistance);
  EXPECT_GT(even, 0.012);
  EXPECT_LT(by_length, 0.004);
  points.confidences = Eigen::VectorXf::Ones(40000);
  points.confidences.head(20000).setConstant(100.f);
  points.normals.colwise().normalize();
  const double by_confidence = meanDistance(reconstructVolumetric(points, options).mesh, sphereDistance);
  EXPECT_NEAR(by_confidence, by_length, 1e-4);
}

TEST(VolumetricInput, TrimmingKeepsWhatTheDataSustain)
{
  const PointSet whole = sphere(60000);
  std::vector<Index> kept;
  for (Index i = 0; i < whole.size(); ++i)
    if (whole.points(2, i) > 0)
      kept.push_back(i);
  const PointSet dome = selectPoints(whole, kept);
  VolumetricOptions options = atDepth(7);
  const VolumetricResult closed = reconstructVolumetric(dome, options);
  EXPECT_TRUE(meshTopology(closed.mesh).watertight);
  options.trim = 5;
  const TriangleMesh open = reconstructVolumetric(dome, options).mesh;
  const MeshTopology topology = meshTopology(open);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.euler, 1); // a disc
  EXPECT_EQ(topology.nonmanifold_edges + topology.inconsistent_edges + topology.nonmanifold_vertices, 0);
  const double margin = 2 * 2.2 / 32; // two cells of the trimming depth
  EXPECT_NEAR(surfaceArea(open), 2 * pi, 2 * pi * margin);
  EXPECT_GT(open.vertices.row(2).minCoeff(), -margin);
  EXPECT_EQ(open.fields.at("support").size(), open.vertexCount());
}

TEST(VolumetricInput, TrimmedMeshEndsAtTheLevelLineForAnyNumberOfThreads)
{
  TriangleMesh mesh = reconstructVolumetric(sphere(20000), atDepth(7)).mesh;
  const Eigen::VectorXf height = mesh.vertices.row(2).transpose();
  mesh.fields["height"] = height;
  TriangleMesh trimmed[2];
  for (const int threads : {1, 3})
    trimmed[threads / 3] = trimMesh(mesh, height, {0.25f, 0.01, 0.01, 0, threads});
  const TriangleMesh& cap = trimmed[0];
  EXPECT_EQ(cap.vertices, trimmed[1].vertices);
  EXPECT_EQ(cap.faces, trimmed[1].faces);
  EXPECT_EQ(cap.fields.at("height"), trimmed[1].fields.at("height"));
  EXPECT_EQ(meshTopology(cap).euler, 1);
  EXPECT_EQ(meshTopology(cap).referenced_vertices, cap.vertexCount());
  EXPECT_GE(cap.vertices.row(2).minCoeff(), 0.25f - 1e-4f);
  EXPECT_LT((cap.fields.at("height").transpose() - cap.vertices.row(2)).cwiseAbs().maxCoeff(), 1e-5f);
  EXPECT_NEAR(surfaceArea(cap), 2 * pi * 0.75, 0.05);
  EXPECT_EQ(trimMesh(mesh, height, {2.f}).faceCount(), 0);
  EXPECT_EQ(trimMesh(mesh, height, {-2.f}).faces, mesh.faces);
  EXPECT_THROW(trimMesh(mesh, height.head(5), {}), std::invalid_argument);
}

TEST(VolumetricInput, ProgressRisesAndCancels)
{
  const PointSet points = sphere(2000);
  double last = -1;
  reconstructVolumetric(points, atDepth(6), [&](std::string_view, double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_EQ(last, 1);
  int calls = 0;
  EXPECT_THROW(reconstructVolumetric(points, atDepth(6), [&](std::string_view, double) { return ++calls < 4; }),
               Cancelled);
}

TEST(VolumetricInput, MemoryEstimateGrowsWithDepth)
{
  const PointSet points = sphere(20000);
  EXPECT_GT(estimateMemory(points, atDepth(8)), 2 * estimateMemory(points, atDepth(7)));
}
} // namespace
} // namespace fresco::test
