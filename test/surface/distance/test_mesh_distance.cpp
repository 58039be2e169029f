// SPDX-License-Identifier: BSD-3-Clause
#include "distance/mesh_distance_statistics.h"
#include "surface/distance/distance_meshes.h"
#include <fresco/surface/core/error_colors.h>
#include <fresco/surface/core/mesh_distance.h>
#include <fresco/surface/core/surface_samples.h>
#include <gtest/gtest.h>
#include <limits>
namespace fresco {
namespace {
using test::gridCube;
using test::gridPlane;
using test::gridSphere;
using test::joined;
using test::moved;
using test::roundedCube;

const float nan_value = std::numeric_limits<float>::quiet_NaN();

MeshDistanceOptions withSamples(int samples)
{
  MeshDistanceOptions options;
  options.samples = samples;
  options.normal_samples = 20000;
  return options;
}

void expectAll(const DistanceStatistics& d, double value, double tolerance)
{
  EXPECT_NEAR(d.max, value, tolerance);
  EXPECT_NEAR(d.mean, value, tolerance);
  EXPECT_NEAR(d.rms, value, tolerance);
}

void expectSame(const DistanceStatistics& a, const DistanceStatistics& b, double relative)
{
  EXPECT_NEAR(a.max, b.max, relative * b.max);
  EXPECT_NEAR(a.mean, b.mean, relative * b.mean);
  EXPECT_NEAR(a.rms, b.rms, relative * b.rms);
  EXPECT_EQ(a.count, b.count);
}

TEST(MeshDistance, TwoSpheres)
{
  const TriangleMesh inner = gridSphere(32, 1.f), outer = gridSphere(32, 1.25f);
  const MeshDistanceResult result = measureMeshDistance(outer, inner, withSamples(20000));
  expectAll(result.vertices.to_reference, 0.25,
            1e-6); // a vertex of a convex body is the closest point along its radius
  const double sag = 1.25 * (1 - std::cos(0.5 * M_SQRT2 * M_PI_2 / 32)); // of a facet below its sphere
  expectAll(result.vertices.from_reference, 0.25, sag);
  expectAll(result.surface.symmetric, 0.25, sag);
  EXPECT_NEAR(result.reference_diagonal, 2 * std::sqrt(3.0), 1e-3);
  EXPECT_LT(result.normals_to_reference.mean, 2.0);
  EXPECT_FALSE(result.inside_out);
  EXPECT_EQ(result.vertices.symmetric.count, inner.vertexCount() + outer.vertexCount());
  const MeshDistanceResult without = measureMeshDistance(outer, inner, withSamples(0));
  EXPECT_EQ(without.surface.symmetric.count, 0) << "not asked for";
  EXPECT_GT(without.normals_to_reference.count, 0) << "these have samples of their own";
}

TEST(MeshDistance, ShiftedPlanes)
{
  const TriangleMesh plane = gridPlane(4.f, 2.f, 8);
  const TriangleMesh above = moved(plane, Eigen::Isometry3f(Eigen::Translation3f(0, 0, 0.3f)));
  const MeshDistanceResult result = measureMeshDistance(above, plane, withSamples(5000));
  expectAll(result.vertices.symmetric, 0.3, 1e-7);
  expectAll(result.surface.symmetric, 0.3, 1e-7);
  EXPECT_EQ(result.normals_to_reference.percentile95, 0.0);
  EXPECT_NEAR(result.reference_diagonal, std::sqrt(20.0), 1e-6);

  // Shifted along itself by 1 and up by 0.3: vertices beyond the rim at x = 4 measure sideways too.
  const TriangleMesh aside = moved(plane, Eigen::Isometry3f(Eigen::Translation3f(1.f, 0, 0.3f)));
  const Eigen::VectorXf distances = vertexDistances(aside, plane);
  for (Index i = 0; i < distances.size(); ++i)
    EXPECT_NEAR(distances[i], std::hypot(0.3, std::max(0.f, aside.vertices(0, i) - 4.f)), 1e-6);
}

TEST(MeshDistance, OneTriangleIsASurface)
{
  TriangleMesh one;
  one.vertices = Points::Identity(3, 3);
  one.faces = Faces(3, 1);
  one.faces << 0, 1, 2;
  const Eigen::Vector3f shift = Eigen::Vector3f::Constant(0.3f); // along its normal
  const TriangleMesh other = moved(one, Eigen::Isometry3f(Eigen::Translation3f(shift)));
  const MeshDistanceResult result = measureMeshDistance(other, one, withSamples(100));
  expectAll(result.vertices.symmetric, shift.norm(), 1e-6);
  expectAll(result.surface.symmetric, shift.norm(), 1e-6);
}

TEST(MeshDistance, CubeAndRoundedCube)
{
  const double radius = 0.5;
  const int cells = 64;
  const TriangleMesh cube = gridCube(cells), rounded = roundedCube(cells, static_cast<float>(radius));
  const MeshDistanceResult result = measureMeshDistance(rounded, cube);
  const double step = M_SQRT2 * 2.0 / cells, sag = step * step / (8 * radius);
  EXPECT_NEAR(result.vertices.to_reference.max, radius * (1 - 1 / std::sqrt(3.0)), 1e-6);
  EXPECT_NEAR(result.vertices.from_reference.max, radius * (std::sqrt(3.0) - 1), 2 * sag);
  EXPECT_EQ(result.vertices.symmetric.max, result.vertices.from_reference.max);
  for (Index i = 0; i < rounded.vertexCount(); ++i) // inside of the cube the nearest side counts
    ASSERT_NEAR(result.vertex_distances[i], 1.f - rounded.vertices.col(i).cwiseAbs().maxCoeff(), 1e-6);
  const Eigen::VectorXf back = vertexDistances(cube, rounded);
  for (Index i = 0; i < cube.vertexCount(); ++i) {
    const Eigen::Vector3f core = cube.vertices.col(i).cwiseMin(0.5f).cwiseMax(-0.5f);
    ASSERT_NEAR(back[i], (cube.vertices.col(i) - core).norm() - 0.5f, 2 * sag);
  }
}

TEST(MeshDistance, EqualMeshesAreAtZero)
{
  const TriangleMesh cube = gridCube(7);
  const MeshDistanceResult result = measureMeshDistance(cube, cube, withSamples(3000));
  EXPECT_EQ(result.vertices.symmetric.max, 0.0);
  EXPECT_LT(result.surface.symmetric.max, 1e-15);
  EXPECT_EQ(result.mesh_topology.edges, result.reference_topology.edges);
}

TEST(MeshDistance, NormalsOfTiltedPlanes)
{
  const TriangleMesh plane = gridPlane(10.f, 10.f, 4);
  for (const float degrees : {10.f, 30.f}) {
    const Eigen::AngleAxisf tilt(degrees * static_cast<float>(M_PI) / 180.f, Eigen::Vector3f::UnitX());
    const NormalDeviation found =
        measureMeshDistance(moved(plane, Eigen::Isometry3f(tilt)), plane, withSamples(0)).normals_to_reference;
    EXPECT_NEAR(found.mean, degrees, 1e-4);
    EXPECT_NEAR(found.median, degrees, 1e-4);
    EXPECT_NEAR(found.percentile95, degrees, 1e-4);
    EXPECT_EQ(found.share_above_20, degrees > 20.f ? 1.0 : 0.0);
  }
}

TEST(MeshDistance, PercentileOfKnownShares)
{
  // Two planes far apart, 90 and 10 % of the area; the second is tilted by 40 degrees.
  const auto tilted = [](float degrees) {
    const Eigen::AngleAxisf tilt(degrees * static_cast<float>(M_PI) / 180.f, Eigen::Vector3f::UnitX());
    return moved(gridPlane(1.f, 1.f, 1), Eigen::Translation3f(100, 0, 0) * Eigen::Isometry3f(tilt));
  };
  const TriangleMesh wide = gridPlane(9.f, 1.f, 1);
  const MeshDistanceResult result =
      measureMeshDistance(joined(wide, tilted(40.f)), joined(wide, tilted(0.f)), withSamples(0));
  EXPECT_NEAR(result.normals_to_reference.mean, 4.0, 0.01);
  EXPECT_NEAR(result.normals_to_reference.share_above_20, 0.1, 1e-3);
  EXPECT_EQ(result.normals_to_reference.median, 0.0);
  EXPECT_NEAR(result.normals_to_reference.percentile95, 40.0, 1e-4);
}

TEST(MeshDistance, QuantilesAreLinearBetweenRanks)
{
  for (const int count : {1, 2, 5, 8, 100}) { // where a rank is whole, and where it is not
    std::vector<double> angles;
    const int odd_step = 7; // shares no factor with the counts: any order
    for (int i = 0; i < count; ++i)
      angles.push_back(count - 1 - i * odd_step % count);
    for (const bool turned : {false, true}) {
      const NormalDeviation found = distance::deviation(angles, turned);
      const auto at = [&](double share) { return turned ? 180 - (1 - share) * (count - 1) : share * (count - 1); };
      EXPECT_NEAR(found.median, at(0.5), 1e-12) << count;
      EXPECT_NEAR(found.percentile95, at(0.95), 1e-12) << count;
    }
  }
  EXPECT_TRUE(distance::mostlyOpposite({80, 101}));
  EXPECT_FALSE(distance::mostlyOpposite({80, 99}));
}

TEST(MeshDistance, InsideOutIsSaid)
{
  const TriangleMesh cube = gridCube(4);
  TriangleMesh turned = cube;
  turned.faces.row(0).swap(turned.faces.row(1));
  const MeshDistanceResult result = measureMeshDistance(turned, cube, withSamples(0));
  EXPECT_TRUE(result.inside_out);
  EXPECT_LT(result.normals_to_reference.median, 1e-6);
}

TEST(MeshDistance, VertexToVertex)
{
  const TriangleMesh plane = gridPlane(8.f, 8.f, 8);
  const TriangleMesh shifted = moved(plane, Eigen::Isometry3f(Eigen::Translation3f(0.5f, 0.5f, 0)));
  MeshDistanceOptions options = withSamples(0);
  options.vertex_to_vertex = true;
  expectAll(measureMeshDistance(shifted, plane, options).vertices.symmetric, std::sqrt(0.5), 1e-7);

  TriangleMesh points = plane;
  points.faces.resize(3, 0); // clouds will do
  const MeshDistanceResult result = measureMeshDistance(points, shifted, options);
  expectAll(result.vertices.symmetric, std::sqrt(0.5), 1e-7);
  EXPECT_EQ(result.normals_to_reference.count, 0);
}

TEST(MeshDistance, RigidMotionAndOriginChangeNothing)
{
  const TriangleMesh cube = gridCube(6), rounded = roundedCube(10, 0.4f);
  const MeshDistanceResult still = measureMeshDistance(rounded, cube, withSamples(0));
  const Eigen::Isometry3f motion =
      Eigen::Translation3f(1.f, -2.f, 0.5f) * Eigen::AngleAxisf(0.7f, Eigen::Vector3f(1, 2, 3).normalized());
  const MeshDistanceResult turned = measureMeshDistance(moved(rounded, motion), moved(cube, motion), withSamples(0));
  expectSame(turned.vertices.to_reference, still.vertices.to_reference, 1e-5);
  expectSame(turned.vertices.from_reference, still.vertices.from_reference, 1e-5);

  TriangleMesh far_mesh = rounded, far_cube = cube; // the same place in the world, kept exact by different origins
  far_mesh.origin << 1e6, 2e6, -3e6;
  far_cube.origin = far_mesh.origin - Eigen::Vector3d(8, 0, -4);
  far_cube.vertices.colwise() += Eigen::Vector3f(8, 0, -4);
  const MeshDistanceResult far = measureMeshDistance(far_mesh, far_cube, withSamples(0));
  expectSame(far.vertices.symmetric, still.vertices.symmetric, 1e-5);
}

TEST(MeshDistance, ThreadsGiveTheSameBits)
{
  const TriangleMesh cube = gridCube(40), rounded = roundedCube(47, 0.3f);
  MeshDistanceOptions options = withSamples(30000);
  options.threads = 1;
  const MeshDistanceResult one = measureMeshDistance(rounded, cube, options);
  options.threads = 4;
  const MeshDistanceResult four = measureMeshDistance(rounded, cube, options);
  EXPECT_EQ(one.vertex_distances, four.vertex_distances);
  expectSame(one.vertices.symmetric, four.vertices.symmetric, 0.0);
  expectSame(one.surface.to_reference, four.surface.to_reference, 0.0);
  expectSame(one.surface.from_reference, four.surface.from_reference, 0.0);
  EXPECT_EQ(one.normals_to_reference.mean, four.normals_to_reference.mean);
  EXPECT_EQ(one.normals_from_reference.percentile95, four.normals_from_reference.percentile95);
}

TEST(MeshDistance, DegenerateFacesAndUnreferencedVertices)
{
  const TriangleMesh plane = gridPlane(2.f, 2.f, 2);
  TriangleMesh odd = moved(plane, Eigen::Isometry3f(Eigen::Translation3f(0, 0, 0.5f)));
  const Index vertices = odd.vertexCount(), faces = odd.faceCount();
  odd.vertices.conservativeResize(3, vertices + 2);
  odd.vertices.col(vertices) << 1.f, 1.f, 100.f;         // named by no face
  odd.vertices.col(vertices + 1).setConstant(nan_value); // neither
  odd.faces.conservativeResize(3, faces + 2);
  odd.faces.col(faces) << 0, 0, 1;     // an edge
  odd.faces.col(faces + 1) << 4, 4, 4; // a point
  const MeshDistanceResult result = measureMeshDistance(odd, plane, withSamples(2000));
  expectAll(result.vertices.symmetric, 0.5, 1e-7);
  expectAll(result.surface.symmetric, 0.5, 1e-7);
  EXPECT_TRUE(std::isnan(result.vertex_distances[vertices]) && std::isnan(result.vertex_distances[vertices + 1]));
  EXPECT_EQ(result.vertices.to_reference.count, vertices);
  EXPECT_EQ(measureMeshDistance(plane, odd).vertices.from_reference.count, vertices);
}

TEST(MeshDistance, Errors)
{
  const TriangleMesh cube = gridCube(2);
  const auto fails = [&](const TriangleMesh& bad) {
    EXPECT_THROW(measureMeshDistance(bad, cube), std::invalid_argument);
    EXPECT_THROW(measureMeshDistance(cube, bad), std::invalid_argument);
    EXPECT_THROW(vertexDistances(cube, bad), std::invalid_argument);
  };
  fails(TriangleMesh());
  TriangleMesh bad = cube;
  bad.faces.resize(3, 0);
  fails(bad);
  bad = cube;
  bad.vertices(2, 1) = nan_value;
  fails(bad);
  bad = cube;
  bad.faces(1, 3) = 1 << 20;
  fails(bad);
  bad = cube;
  bad.vertices.setZero();
  fails(bad); // no area
  bad = cube;
  bad.origin[0] = nan_value;
  fails(bad);
  MeshDistanceOptions options = withSamples(-1);
  EXPECT_THROW(measureMeshDistance(cube, cube, options), std::invalid_argument);
  options = {};
  options.normal_samples = -1;
  EXPECT_THROW(measureMeshDistance(cube, cube, options), std::invalid_argument);
  options = {};
  options.threads = -1;
  EXPECT_THROW(measureMeshDistance(cube, cube, options), std::invalid_argument);
  EXPECT_THROW(measureMeshDistance(cube, cube, {}, [](std::string_view, double) { return false; }), Cancelled);
  options = {};
  options.vertex_to_vertex = true;
  bad = cube;
  bad.faces.resize(3, 0);
  bad.vertices(0, 0) = nan_value;
  EXPECT_THROW(measureMeshDistance(bad, cube, options), std::invalid_argument);
}

TEST(SurfaceSamples, UniformOverTheAreaAndReproducible)
{
  TriangleMesh mesh =
      joined(gridPlane(3.f, 1.f, 1), moved(gridPlane(1.f, 1.f, 10), Eigen::Isometry3f(Eigen::Translation3f(0, 0, 5))));
  const Index count = 40000;
  const SurfaceSamples samples = sampleSurface(mesh, count, 7, 1);
  const Index below = (samples.points.row(2).array() < 1.0).count();
  EXPECT_NEAR(static_cast<double>(below) / count, 0.75, 1e-4); // one sample per strip of equal area
  const auto lower = samples.points.leftCols(below);
  EXPECT_NEAR(lower.row(0).mean(), 1.5, 5 * 3 / std::sqrt(12.0 * static_cast<double>(below)));
  EXPECT_NEAR(lower.row(1).mean(), 0.5, 5 * 1 / std::sqrt(12.0 * static_cast<double>(below)));
  EXPECT_NEAR(lower.row(0).array().square().mean(), 3.0, 0.05);
  EXPECT_EQ(sampleSurface(mesh, count, 7, 4).points, samples.points);
  EXPECT_NE(sampleSurface(mesh, count, 8, 4).points, samples.points);
  EXPECT_THROW(sampleSurface(mesh, 0, 7), std::invalid_argument);
  EXPECT_THROW(sampleSurface(TriangleMesh(), 10, 7), std::invalid_argument);
}

TEST(ErrorColors, RedGreenBlue)
{
  Eigen::VectorXf distances(6);
  distances << 0.f, 1.f, 2.f, 5.f, nan_value, 0.5f;
  const Colors colors = errorColors(distances, 2.f);
  using Color = Eigen::Matrix<std::uint8_t, 3, 1>;
  EXPECT_EQ(colors.col(0), Color(255, 0, 0));
  EXPECT_EQ(colors.col(1), Color(0, 255, 0));
  EXPECT_EQ(colors.col(2), Color(0, 0, 255));
  EXPECT_EQ(colors.col(3), Color(0, 0, 255));
  EXPECT_EQ(colors.col(4), Color(128, 128, 128));
  EXPECT_EQ(colors.col(5), Color(255, 255, 0));
  EXPECT_EQ(errorColors(Eigen::VectorXf::Zero(1), 0.f).col(0), Color(255, 0, 0));
  EXPECT_EQ(errorColors(Eigen::VectorXf::Ones(1), 0.f).col(0), Color(0, 0, 255));
  EXPECT_THROW(errorColors(distances, -1.f), std::invalid_argument);
  EXPECT_THROW(errorColors(distances, nan_value), std::invalid_argument);
}
} // namespace
} // namespace fresco
