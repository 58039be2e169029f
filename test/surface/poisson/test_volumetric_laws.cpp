// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/select.h"
#include "poisson/octree/splat.h"
#include "poisson/samples/density.h"
#include "poisson/solver/base_solver.h"
#include "poisson/solver/solve.h"
#include "surface/poisson/volumetric_shapes.h"
#include "test_data.h"
#include <Eigen/Geometry>
#include <fresco/io/mesh_io.h>
#include <fresco/surface/core/mesh_distance.h>
using namespace fresco::poisson;
namespace fresco::test {
namespace {
using namespace poisson;

TEST(VolumetricLaws, NormalsOfASmoothSurfaceShowNoGrid)
{
  for (const int depth : {6, 7}) // flat triangles alone account for about a quarter of a degree at depth 7
    EXPECT_LT(meanAngleToSphere(reconstructVolumetric(sphere(100000), atDepth(depth)).mesh), 0.75) << depth;
}

TEST(VolumetricLaws, UnscreenedSolutionIsTheIndicatorFunction)
{
  VolumetricOptions options = atDepth(6);
  options.point_weight = 0;
  Samples samples = gatherSamples(sphere(60000), options);
  const Octree tree = buildOctree(samples.codes, 6, 5, 1);
  const Density density(tree, samples, 1);
  estimateDensity(tree, density, 1.f, samples, 1);
  const Constraints constraints = splatNormals(tree, finestLevel(samples, 1), normalsOf(samples, 1), 1);
  const SampleLevels levels = sampleLevels(finestLevel(samples, 1), normalsOf(samples, 1), tree, 1);
  const NodeField chi = solveBase(tree, constraints.fine, levels, 0.f, 1);
  const double cell = 2.2 / 32;
  for (Index b = 0; b < tree.levels[5].size(); ++b)
    for (int n = 0; n < 125; ++n) {
      const Eigen::Vector3f node = tree.levels[5].origin(b) + Eigen::Vector3i(n % 5, n / 5 % 5, n / 25).cast<float>();
      const double radius = (node.array().cast<double>() * cell - 1.1).matrix().norm();
      if (std::abs(radius - 1) > 3 * cell) {
        EXPECT_NEAR(chi.value(tree.levels[5], b, n % 5, n / 5 % 5, n / 25), radius < 1 ? -0.5 : 0.5, 0.04) << radius;
      }
    }
}

/// The integral of V . grad 1 is 0. Else empty space would have sources, and chi would rise or fall there.
TEST(VolumetricLaws, RightHandSidesSumUpToZero)
{
  std::vector<Index> upper;
  const PointSet all = sphere(60000);
  for (Index i = 0; i < all.size(); ++i)
    if (all.points(2, i) > 0.3f)
      upper.push_back(i);
  for (const int depth : {5, 6, 7}) {
    Samples samples = gatherSamples(selectPoints(all, upper), atDepth(depth));
    const Octree tree = buildOctree(samples.codes, depth, 4, 1);
    estimateDensity(tree, Density(tree, samples, 1), 1.f, samples, 1);
    const Constraints constraints = splatNormals(tree, finestLevel(samples, 1), normalsOf(samples, 1), 1);
    double sum = 0, absolute = 0;
    for (Index b = 0; b < tree.levels[4].size(); ++b) {
      float held[nodes_per_brick];
      constraints.fine[4].loadHeld(tree.levels[4], b, held);
      for (const float value : held) {
        sum += value;
        absolute += std::abs(value);
      }
    }
    EXPECT_LT(std::abs(sum), 1e-5 * absolute) << depth;
  }
}

/// Each row of weights sums to one, has the derivative of its values, and stands for hat functions averaged evenly: linear
/// functions are kept.
template <typename Weights>
void expectSmoothedHats()
{
  for (float t = 2.01f; t < 4.f; t += 0.0473f) {
    constexpr float step = 1e-2f;
    const Weights w(t), next(t + step);
    float sum = 0, derivative = 0, mean = 0;
    for (std::size_t k = 0; k < Weights::count; ++k) {
      EXPECT_GE(w.value[k], 0.f);
      sum += w.value[k];
      derivative += w.derivative[k];
      mean += w.value[k] * static_cast<float>(w.first + static_cast<int>(k));
      if (next.first == w.first) {
        EXPECT_NEAR((next.value[k] - w.value[k]) / step, 0.5f * (next.derivative[k] + w.derivative[k]), 1e-3f);
      }
    }
    EXPECT_NEAR(sum, 1.f, 1e-5f);
    EXPECT_NEAR(derivative, 0.f, 1e-5f);
    EXPECT_NEAR(mean, t, 1e-4f);
  }
}

TEST(VolumetricLaws, SpreadingKernelsKeepSumAndMean)
{
  expectSmoothedHats<BoxWeights>();
  expectSmoothedHats<TentWeights>();
}

TEST(VolumetricLaws, SelectedIndicesDoNotDependOnThreads)
{
  const auto odd = [](Index i) { return i % 7 == 3 || i % 1000 == 0; };
  for (const Index n : {0, 1, 16384, 50000}) {
    Array<std::uint32_t> expected;
    for (Index i = 0; i < n; ++i)
      if (odd(i))
        expected.push_back(static_cast<std::uint32_t>(i));
    EXPECT_EQ(selectIndices(n, 1, odd), expected);
    EXPECT_EQ(selectIndices(n, 3, odd), expected);
  }
  EXPECT_EQ(runBegins(7, 2, [](Index i) { return i / 3; }), (Array<std::uint32_t>{0, 3, 6, 7}));
}

TEST(VolumetricLaws, FarOutliersNeitherWasteTheOctreeNorSpoilTheMesh)
{
  const PointSet clean = sphere(20000);
  PointSet points = clean;
  points.points.conservativeResize(3, 20006);
  points.normals.conservativeResize(3, 20006);
  for (int i = 0; i < 6; ++i) {
    points.points.col(20000 + i) = 1e4f * Eigen::Vector3f::Unit(i / 2) * (i % 2 ? 1.f : -1.f);
    points.normals.col(20000 + i) = Eigen::Vector3f::UnitX();
  }
  const VolumetricResult expected = reconstructVolumetric(clean, atDepth(6));
  const VolumetricResult result = reconstructVolumetric(points, atDepth(6));
  EXPECT_EQ(result.left_out_points, 6);
  EXPECT_EQ(result.cell_size, expected.cell_size);
  EXPECT_EQ(result.mesh.vertices, expected.mesh.vertices);
}

/// Without weights of scatter most vertices lie off.
TEST(VolumetricLaws, ScatteredPointsMakeNoSurface)
{
  PointSet points = sphere(40000);
  addScattered(points, 2000, 1.5f);
  const VolumetricResult result = reconstructVolumetric(points, atDepth(7));
  Index off = 0;
  for (Index v = 0; v < result.mesh.vertexCount(); ++v)
    off += std::abs(sphereDistance(result.mesh.vertices.col(v).cast<double>())) > 2 * result.cell_size;
  EXPECT_LT(off, 0.05 * result.mesh.vertexCount());
}

TEST(VolumetricLaws, PointsGivenAwayGiveTheSameAndAreFreed)
{
  PointSet points = torus(10000, 0.4, 3);
  const auto left = [&] { return points.size(); };
  const VolumetricResult expected = reconstructVolumetric(points, atDepth(6));
  const VolumetricResult result = reconstructVolumetric(std::move(points), atDepth(6));
  EXPECT_EQ(result.mesh.vertices, expected.mesh.vertices);
  EXPECT_EQ(left(), 0);
}

TEST(VolumetricLaws, TrimmingByLevelsFollowsTheData)
{
  double before = 0;
  for (const Index count : {4000, 64000}) {
    const PointSet whole = sphere(count);
    std::vector<Index> upper;
    for (Index i = 0; i < count; ++i)
      if (whole.points(2, i) > 0)
        upper.push_back(i);
    VolumetricOptions options = atDepth(7);
    options.trim_levels = 2;
    const VolumetricResult result = reconstructVolumetric(selectPoints(whole, upper), options);
    EXPECT_GT(result.mesh.vertices.row(2).minCoeff(), -0.5f);
    EXPECT_GT(surfaceArea(result.mesh), 0.97 * 2 * pi);
    EXPECT_FALSE(meshTopology(result.mesh).watertight);
    if (before > 0) {
      EXPECT_NEAR(result.trim_depth - before, 2, 0.3); // 16 times the points: two levels
    }
    before = result.trim_depth;
  }
}

/// Square plate of side 2, turned against the axes.
PointSet plate(Index count, float thickness)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(-1, 1);
  PointSet set;
  set.points.resize(3, count);
  set.normals.setZero(3, count);
  for (Index i = 0; i < count; ++i) {
    const Index axis = i % 50 == 0 ? i / 100 % 2 : 2;
    const float side = i / 50 % 2 == 0 ? 1.f : -1.f;
    set.points.col(i) << unit(random), unit(random), unit(random);
    set.points(axis, i) = side;
    set.normals(axis, i) = side;
  }
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.4f, Eigen::Vector3f(1.f, 1.f, 0.3f).normalized()).matrix();
  set.points = turn * Eigen::Vector3f(1.f, 1.f, thickness / 2).asDiagonal() * set.points;
  set.normals = turn * set.normals;
  return set;
}

TEST(VolumetricLaws, PlateOfOneCellsThicknessHasNoHoles)
{
  const float thickness = 0.05f;
  const VolumetricResult result = reconstructVolumetric(plate(200000, thickness), atDepth(6));
  EXPECT_LT(thickness, 1.5 * result.cell_size);
  const MeshTopology topology = meshTopology(result.mesh);
  EXPECT_TRUE(topology.watertight);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.euler, 2);
  EXPECT_NEAR(signedVolume(result.mesh), 4.0 * thickness, 0.15 * 4.0 * thickness);
}

TEST(VolumetricLaws, ScreeningZeroScalesWithThePoints)
{
  VolumetricOptions options = atDepth(6);
  options.point_weight = 0;
  PointSet points = torus(20000, 0.4, 5);
  const TriangleMesh mesh = reconstructVolumetric(points, options).mesh;
  points.points *= 64.f; // a power of two: nothing is rounded
  const TriangleMesh scaled = reconstructVolumetric(points, options).mesh;
  EXPECT_TRUE(scaled.vertices.isApprox(64.f * mesh.vertices, 1e-6f));
  EXPECT_EQ(scaled.faces, mesh.faces);
}

TEST(VolumetricLaws, FandiskFromItsVerticesIsCloseAndClosed)
{
  FRESCO_NEED_DATA("fandisk.obj");
  const TriangleMesh truth = readMesh(dataFolder() + "/fandisk.obj");
  PointSet points;
  points.points = truth.vertices;
  points.normals = vertexNormals(truth);
  const TriangleMesh mesh = reconstructVolumetric(points).mesh;
  MeshDistanceOptions options;
  options.normal_samples = 50000;
  const MeshDistanceResult distance = measureMeshDistance(mesh, truth, options);
  const double percent = 100 / distance.reference_diagonal;
  EXPECT_TRUE(distance.mesh_topology.watertight);
  EXPECT_EQ(distance.mesh_topology.components, 1);
  EXPECT_LT(distance.vertices.symmetric.max * percent, 0.92);
  EXPECT_LT(distance.vertices.symmetric.mean * percent, 0.0627);
  EXPECT_LT(distance.vertices.symmetric.rms * percent, 0.15);
  EXPECT_LT(distance.normals_to_reference.mean, 6.6);
}
} // namespace
} // namespace fresco::test
