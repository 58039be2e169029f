// SPDX-License-Identifier: BSD-3-Clause
#include "common/shapes.h"
#include "surface/optimization/optimization_shapes.h"
#include "test_data.h"
#include <Eigen/Geometry>
#include <fresco/core/constants.h>
#include <fresco/io/mesh_io.h>
#include <fresco/surface/core/mesh_distance.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
#include <gtest/gtest.h>
#include <limits>
#include <random>
namespace fresco {
namespace {
constexpr double cell = 2.0 / 20;

TriangleMesh rounded() { return test::roundedCube(20, 0.15); }

struct Settings {
  int threads = 0;
  bool flip = false;
};

NormalFilteringResult optimized(const TriangleMesh& mesh, const PointSet& points, const Settings& settings = {})
{
  NormalFilteringOptions options;
  options.threads = settings.threads;
  options.flip = settings.flip;
  return filterSurface(mesh, points, options);
}

TEST(Optimization, EnergyNeverRises)
{
  const NormalFilteringResult result = optimized(rounded(), test::cubePoints(8000, 0.01));
  ASSERT_FALSE(result.steps.empty());
  EXPECT_EQ(result.iterations, Index(result.steps.size()));
  for (const NormalFilteringStep& step : result.steps)
    EXPECT_LE(step.after, step.before * (1 + 1e-12));
}

TEST(Optimization, FitsBetterAndStaysWatertight)
{
  const TriangleMesh before = rounded();
  const TriangleMesh after = optimized(before, test::cubePoints(8000, 0.01)).mesh;
  EXPECT_LT(test::cubeErrors(after).first, test::cubeErrors(before).first);
  EXPECT_TRUE(meshTopology(after).watertight);
  EXPECT_EQ(after.faces, before.faces);
}

/// The faces that `turn` names are inside out.
template <typename Turn>
TriangleMesh turnedWhere(TriangleMesh mesh, const Turn& turn)
{
  for (Index f = 0; f < mesh.faceCount(); ++f)
    if (turn(f))
      std::swap(mesh.faces(1, f), mesh.faces(2, f));
  return mesh;
}

TEST(Optimization, FacesInsideOutAreTurned)
{
  const TriangleMesh mesh = rounded();
  const PointSet points = test::cubePoints(8000, 0.01);
  const NormalFilteringResult expected = optimized(mesh, points);
  EXPECT_EQ(expected.turned_faces, 0);
  const auto is_left = [&](Index f) { return mesh.vertices(0, mesh.faces(0, f)) < 0; };
  for (const bool all : {true, false}) {
    const TriangleMesh wrong = turnedWhere(mesh, [&](Index f) { return all || is_left(f); });
    const NormalFilteringResult result = optimized(wrong, points);
    EXPECT_GT(result.turned_faces, mesh.faceCount() / 3);
    EXPECT_EQ(result.mesh.faces, mesh.faces);
    EXPECT_EQ(result.mesh.vertices, expected.mesh.vertices);
    EXPECT_EQ(result.left_out_points, expected.left_out_points);
  }
}

TEST(Optimization, FewPointsThatOpposeTurnNothing)
{
  PointSet points = test::cubePoints(8000, 0.01);
  for (Index i = 0; i < points.size(); i += 3)
    points.normals.col(i) *= -1.f;
  EXPECT_EQ(optimized(rounded(), points).turned_faces, 0);
  points.normals.resize(3, 0);
  EXPECT_EQ(optimized(turnedWhere(rounded(), [](Index) { return true; }), points).turned_faces, 0);
}

TEST(Optimization, SameBitsForAnyNumberOfThreads)
{
  const PointSet points = test::cubePoints(10000, 0.01);
  const TriangleMesh a = optimized(rounded(), points, {1, true}).mesh, b = optimized(rounded(), points, {4, true}).mesh;
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.faces, b.faces);
}

TEST(Optimization, NoDamageOnASphere)
{
  const TriangleMesh mesh = test::sphere(1.f, 4);
  PointSet points;
  points.points = test::sphere(1.f, 5).vertices;
  points.normals = points.points;
  const TriangleMesh after = optimized(mesh, points).mesh;
  // The sagitta of the triangles of the mesh: nothing is farther off than its flat faces are.
  double longest = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    longest =
        std::max<double>(longest, (mesh.vertices.col(mesh.faces(0, f)) - mesh.vertices.col(mesh.faces(1, f))).norm());
  for (Index v = 0; v < after.vertexCount(); ++v)
    EXPECT_NEAR(after.vertices.col(v).norm(), 1.0, longest * longest / 3);
  const Points normals = faceNormals(after);
  for (Index f = 0; f < after.faceCount(); ++f) {
    const Eigen::Vector3f middle = (after.vertices.col(after.faces(0, f)) + after.vertices.col(after.faces(1, f)) +
                                    after.vertices.col(after.faces(2, f))) /
                                   3;
    EXPECT_GT(normals.col(f).dot(middle.normalized()), std::cos(0.1)) << "a staircase";
  }
}

/// Root mean square distance from the unit sphere, and mean angle in degrees between its faces and the sphere.
std::pair<double, double> sphereErrors(const TriangleMesh& mesh)
{
  const Points normals = faceNormals(mesh);
  double angles = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k)
      middle += mesh.vertices.col(mesh.faces(k, f));
    angles += std::acos(std::min(1.f, normals.col(f).dot(middle.normalized())));
  }
  const double squares = (mesh.vertices.colwise().norm().array() - 1.f).square().mean();
  return {std::sqrt(squares), angles / mesh.faceCount() * degrees_per_radian};
}

TEST(Optimization, NoisySphereGetsNoFacets)
{
  PointSet points;
  points.points = test::sphere(1.f, 6).vertices;
  points.normals = points.points;
  std::mt19937 random(11);
  std::normal_distribution<float> noise(0.f, 0.005f);
  for (Index i = 0; i < points.size(); ++i)
    points.points.col(i) *= 1.f + noise(random);
  VolumetricOptions options;
  options.depth = 6;
  const TriangleMesh before = reconstructVolumetric(points, options).mesh;
  const auto [rms_before, angle_before] = sphereErrors(before);
  const auto [rms_after, angle_after] = sphereErrors(filterSurface(before, points).mesh);
  EXPECT_LE(rms_after, rms_before);
  EXPECT_LE(angle_after, angle_before);
}

TEST(Optimization, PointsThatAreNamedTwiceAreNoLessNoisy)
{
  PointSet once, twice;
  once.points = test::sphere(1.f, 5).vertices;
  std::mt19937 random(12);
  std::normal_distribution<float> noise(0.f, 0.01f);
  for (Index i = 0; i < once.size(); ++i)
    once.points.col(i) *= 1.f + noise(random);
  twice.points.resize(3, 2 * once.size());
  twice.points << once.points, once.points;
  const TriangleMesh mesh = test::sphere(1.f, 4);
  const double expected = filterSurface(mesh, once).noise;
  EXPECT_NEAR(expected, 0.01, 0.002);
  EXPECT_NEAR(filterSurface(mesh, twice).noise, expected, 0.1 * expected);
}

TEST(Optimization, NeighboursThatErrAlikeAreNoLessNoisy)
{
  PointSet
      points; // each with a companion a tenth of the spacing away and as far off; faces are smaller than that spacing
  const TriangleMesh mesh = test::sphere(1.f, 6);
  const Eigen::Matrix3Xf once = test::sphere(1.f, 4).vertices;
  std::mt19937 random(12);
  std::normal_distribution<float> noise(0.f, 0.01f);
  points.points.resize(3, 2 * once.cols());
  for (Index i = 0; i < once.cols(); ++i) {
    const float radius = 1.f + noise(random);
    points.points.col(2 * i) = radius * once.col(i);
    points.points.col(2 * i + 1) = radius * (once.col(i) + 0.007f * once.col(i).unitOrthogonal()).normalized();
  }
  EXPECT_NEAR(filterSurface(mesh, points).noise, 0.01, 0.002);
}

TEST(Optimization, BendsOfAFewCellsStayRound)
{
  for (const float noise : {0.f, 0.01f, 0.03f})
    for (const float cube : {7.6f, 8.8f}) { // of 32 cells: the sphere's radius is about four of them
      std::mt19937 random(3);
      std::normal_distribution<float> gaussian;
      PointSet points;
      points.points.resize(3, 6000);
      points.normals.resize(3, 6000);
      for (Index i = 0; i < points.size(); ++i) {
        points.normals.col(i) = Eigen::Vector3f(gaussian(random), gaussian(random), gaussian(random)).normalized();
        points.points.col(i) = (1.f + noise * gaussian(random)) * points.normals.col(i);
      }
      VolumetricOptions options;
      options.depth = 5;
      options.scale = cube / 2;
      const TriangleMesh before = reconstructVolumetric(points, options).mesh;
      EXPECT_LE(sphereErrors(filterSurface(before, points).mesh).second, sphereErrors(before).second)
          << noise << ' ' << cube;
    }
}

TEST(Optimization, ContradictingDataDrawNoSplinters)
{
  const TriangleMesh mesh = test::sphere(1.f, 3);
  PointSet points;
  points.points = test::sphere(1.f, 5).vertices;
  std::mt19937 random(5);
  for (Index i = 0; i < points.points.size(); ++i) // noise as large as an edge
    points.points.data()[i] += 0.15f * (static_cast<float>(random() % 2000) / 1000.f - 1.f) * 1.7f;
  const NormalFilteringResult result = filterSurface(mesh, points);
  const double farthest = (result.mesh.vertices - mesh.vertices).colwise().norm().maxCoeff();
  EXPECT_LE(farthest, 4 * result.edge_length); // three, and what the mending of inverted faces may add
  EXPECT_LT(result.steps.size(), 15U);         // nothing to converge to: no steps are wasted
  EXPECT_FALSE(result.converged);
}

TEST(Optimization, CreasesAreSharpAndFlatPartsFlat)
{
  for (const double noise : {0.0, 0.01}) {
    const TriangleMesh before = rounded();
    const NormalFilteringResult result = filterSurface(before, test::cubePoints(20000, noise));
    EXPECT_LT(test::bentShare(result.mesh), 0.2 * test::bentShare(before)) << noise;
    EXPECT_LT(test::cubeErrors(result.mesh).first, 0.25 * noise + 0.02 * cell) << noise; // many data averaged
    EXPECT_LT(test::cubeErrors(result.mesh).second, noise + 0.5 * cell) << noise;
    EXPECT_NEAR(result.noise, noise, 0.3 * noise + 0.02 * cell);
  }
}

TEST(Optimization, ReachesEdgesAndCorners)
{
  const TriangleMesh after = filterSurface(rounded(), test::cubePoints(20000, 0.0)).mesh;
  const MeshDistanceResult distance = measureMeshDistance(after, [] {
    TriangleMesh cube = test::box(Eigen::Vector3f::Constant(2));
    cube.vertices.array() -= 1.f;
    return cube;
  }());
  const double rounding = 0.15 * (std::sqrt(3.0) - 1); // how far the corners were off
  EXPECT_LT(distance.vertices.symmetric.max, 0.4 * rounding);
  EXPECT_LT(distance.normals_to_reference.mean, 2.0);
}

TEST(Optimization, WithoutDataVerticesStay)
{
  const TriangleMesh mesh = rounded();
  PointSet half = test::cubePoints(20000, 0.0);
  std::vector<Index> kept;
  for (Index i = 0; i < half.size(); ++i)
    if (half.points(0, i) > 0.f)
      kept.push_back(i);
  const NormalFilteringResult result = filterSurface(mesh, selectPoints(half, kept));
  EXPECT_LT(result.covered_vertices, mesh.vertexCount() * 2 / 3);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    if (mesh.vertices(0, v) < -0.3f) {
      EXPECT_EQ(mesh.vertices.col(v), result.mesh.vertices.col(v));
    }
}

TEST(Optimization, AttributesPassThrough)
{
  TriangleMesh mesh = rounded();
  mesh.colors.setRandom(3, mesh.vertexCount());
  mesh.fields["support"] = Eigen::VectorXf::LinSpaced(mesh.vertexCount(), 0, 1);
  mesh.normals = vertexNormals(mesh);
  mesh.origin = {5e6, -3e6, 100};
  PointSet points = test::cubePoints(5000, 0.0);
  points.origin = mesh.origin + Eigen::Vector3d(1, 2, 3);
  points.points.colwise() -= Eigen::Vector3f(1, 2, 3);
  const TriangleMesh after = filterSurface(mesh, points).mesh;
  EXPECT_EQ(after.colors, mesh.colors);
  EXPECT_EQ(after.fields.at("support"), mesh.fields.at("support"));
  EXPECT_EQ(after.origin, mesh.origin);
  EXPECT_EQ(after.normals, vertexNormals(after));
  EXPECT_LT(test::cubeErrors(after).first, 0.02 * cell);
}

TEST(Optimization, MovesAndScalesWithItsInput)
{
  const TriangleMesh mesh = test::roundedCube(12, 0.3);
  const PointSet points = test::cubePoints(5000, 0.01);
  const Eigen::Matrix3f R = Eigen::AngleAxisf(0.7f, Eigen::Vector3f(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Vector3f t(3, -4, 5);
  const float s = 0.01f;
  TriangleMesh other = mesh;
  other.vertices = (s * R * mesh.vertices).colwise() + t * s;
  PointSet others = points;
  others.points = (s * R * points.points).colwise() + t * s;
  others.normals = R * points.normals;
  NormalFilteringOptions options;
  options.iterations = 3;
  const Points expected = (s * R * filterSurface(mesh, points, options).mesh.vertices).colwise() + t * s;
  const Points found = filterSurface(other, others, options).mesh.vertices;
  EXPECT_LT((found - expected).cwiseAbs().mean(), 1e-3 * s);
}

TEST(Optimization, FlipsKeepTheTopology)
{
  NormalFilteringOptions options;
  options.flip = true;
  const TriangleMesh mesh = rounded();
  const NormalFilteringResult result = filterSurface(mesh, test::cubePoints(20000, 0.005), options);
  const MeshTopology topology = meshTopology(result.mesh);
  EXPECT_TRUE(topology.watertight);
  EXPECT_EQ(topology.euler, 2);
  EXPECT_LT(test::bentShare(result.mesh), 0.2 * test::bentShare(mesh));
}

TEST(Optimization, StrangeMeshesAreKept)
{
  TriangleMesh mesh = test::roundedCube(10, 0.3);
  const Index faces = mesh.faceCount(), vertices = mesh.vertexCount();
  mesh.faces.conservativeResize(3, faces + 3);
  mesh.faces.col(faces) << 5, 5, 6;                                                   // degenerate
  mesh.faces.col(faces + 1) << 5, 6, 5;                                               // degenerate
  mesh.faces.col(faces + 2) << mesh.faces(0, 0), mesh.faces(1, 0), mesh.faces(2, 50); // third face at an edge
  mesh.vertices.conservativeResize(3, vertices + 1);
  mesh.vertices.col(vertices).setConstant(std::numeric_limits<float>::quiet_NaN()); // nobody names it
  PointSet points = test::cubePoints(4000, 0.0);
  points.points.col(3).setConstant(std::numeric_limits<float>::infinity());
  points.normals.col(5).setConstant(std::numeric_limits<float>::quiet_NaN());
  for (const bool flip : {false, true}) {
    NormalFilteringOptions options;
    options.flip = flip;
    const NormalFilteringResult result = filterSurface(mesh, points, options);
    EXPECT_TRUE(result.mesh.vertices.leftCols(vertices).allFinite());
    EXPECT_GE(result.left_out_points, 1);
    EXPECT_LE(meshTopology(result.mesh).nonmanifold_edges, meshTopology(mesh).nonmanifold_edges);
  }
}

TEST(Optimization, BadInputIsAnError)
{
  const TriangleMesh mesh = test::sphere(1.f, 2);
  const PointSet points = test::cubePoints(100, 0.0);
  PointSet far = points, none, broken = points;
  far.points.array() += 1000.f;
  broken.points.setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_THROW(filterSurface(mesh, far), std::invalid_argument);
  EXPECT_THROW(filterSurface(mesh, none), std::invalid_argument);
  EXPECT_THROW(filterSurface(mesh, broken), std::invalid_argument);
  EXPECT_THROW(filterSurface(TriangleMesh(), points), std::invalid_argument);
  TriangleMesh bad = mesh;
  bad.vertices(0, 3) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(filterSurface(bad, points), std::invalid_argument);
  bad = mesh;
  bad.faces(0, 0) = 100000;
  EXPECT_THROW(filterSurface(bad, points), std::invalid_argument);
  bad = mesh;
  bad.vertices.setZero();
  EXPECT_THROW(filterSurface(bad, points), std::invalid_argument);
  for (const auto& change : std::vector<std::function<void(NormalFilteringOptions&)>>{
           [](auto& o) { o.iterations = 0; }, [](auto& o) { o.smoothness_weight = NAN; },
           [](auto& o) { o.tangential_weight = INFINITY; }, [](auto& o) { o.tolerance = -1; },
           [](auto& o) { o.threads = -1; }}) {
    NormalFilteringOptions options;
    change(options);
    EXPECT_THROW(filterSurface(mesh, points, options), std::invalid_argument);
  }
  EXPECT_THROW(filterSurface(mesh, points, {}, [](auto, double) { return false; }), Cancelled);
}

TEST(Optimization, FandiskGetsItsEdgesBack)
{
  FRESCO_NEED_DATA("fandisk.obj");
  const TriangleMesh model = readMesh(test::dataFolder() + "/fandisk.obj");
  PointSet points;
  points.points = model.vertices;
  points.normals = vertexNormals(model);
  points.origin = model.origin;
  const TriangleMesh before = reconstructVolumetric(points,
                                                    [] {
                                                      VolumetricOptions options;
                                                      options.depth = 6;
                                                      return options;
                                                    }())
                                  .mesh;
  const TriangleMesh after = filterSurface(before, points).mesh;
  const MeshDistanceResult a = measureMeshDistance(before, model), b = measureMeshDistance(after, model);
  EXPECT_LT(b.vertices.symmetric.rms, 0.6 * a.vertices.symmetric.rms);
  EXPECT_LT(b.normals_to_reference.mean, 0.6 * a.normals_to_reference.mean);
  EXPECT_TRUE(b.mesh_topology.watertight);
}
} // namespace
} // namespace fresco
