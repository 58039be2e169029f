// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/search/ray_scene.h>
#include <fresco/search/triangle_tree.h>
#include <gtest/gtest.h>
#include <random>
namespace fresco {
namespace {
using Eigen::Vector3d;

enum class Soup { ordinary, needles, flat, points, clustered };

Points randomPoints(Index count, std::uint32_t seed, float size = 1.f)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-size, size);
  return Points::NullaryExpr(3, count, [&] { return coordinate(random); });
}

// Triangles without common vertices.
TriangleMesh randomSoup(Soup kind, Index count, std::uint32_t seed)
{
  TriangleMesh mesh;
  mesh.faces = Eigen::VectorXi::LinSpaced(3 * count, 0, static_cast<int>(3 * count) - 1).reshaped(3, count);
  mesh.vertices.resize(3, 3 * count);
  const Points centers = randomPoints(count, seed), offsets = randomPoints(3 * count, seed + 1, 0.1f);
  for (Index f = 0; f < count; ++f) {
    const Eigen::Vector3f center = kind == Soup::clustered ? Eigen::Vector3f::Zero() : Eigen::Vector3f(centers.col(f));
    for (Index i = 0; i < 3; ++i)
      mesh.vertices.col(3 * f + i) = center + offsets.col(3 * f + i);
    const Eigen::Vector3f a = mesh.vertices.col(3 * f), b = mesh.vertices.col(3 * f + 1);
    if (kind == Soup::needles)
      mesh.vertices.col(3 * f + 2) = a + 0.3f * (b - a) + 1e-6f * offsets.col(3 * f + 2);
    if (kind == Soup::flat)
      mesh.vertices.col(3 * f + 2) = f % 2 ? a : Eigen::Vector3f(a + 2.f * (b - a));
    if (kind == Soup::points)
      mesh.vertices.col(3 * f + 1) = mesh.vertices.col(3 * f + 2) = a;
  }
  return mesh;
}

// Least distance by an exhaustive and independent method: the triangle a + s u + t v is a convex set, on which the
// distance is minimised by searching s exactly for each of the three edges and by solving the normal equations inside.
double bruteForceDistance(const TriangleMesh& mesh, Index face, const Vector3d& p)
{
  using Long = Eigen::Matrix<long double, 3, 1>;
  const auto corner = [&](int i) -> Long { return mesh.vertices.col(mesh.faces(i, face)).cast<long double>(); };
  const Long q = p.cast<long double>();
  long double best = std::numeric_limits<long double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Long a = corner(i), d = corner((i + 1) % 3) - a;
    const long double length2 = d.squaredNorm();
    const long double s = length2 > 0 ? std::min<long double>(1, std::max<long double>(0, d.dot(q - a) / length2)) : 0;
    best = std::min(best, (a + s * d - q).norm());
  }
  const Long a = corner(0), u = corner(1) - a, v = corner(2) - a, w = q - a;
  const long double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
  if (det > 1e-22L * uu * vv) {
    const long double s = (vv * u.dot(w) - uv * v.dot(w)) / det, t = (uu * v.dot(w) - uv * u.dot(w)) / det;
    if (s >= 0 && t >= 0 && s + t <= 1)
      best = std::min(best, (w - s * u - t * v).norm());
  }
  return static_cast<double>(best);
}

ClosestPoint bruteForce(const TriangleMesh& mesh, const Vector3d& p)
{
  ClosestPoint best;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    if (const double distance = bruteForceDistance(mesh, f, p); distance < best.distance)
      best = {distance, f, Vector3d::Zero()};
  return best;
}

class TriangleTreeSoup : public testing::TestWithParam<Soup> {};

TEST_P(TriangleTreeSoup, EqualsBruteForce)
{
  for (const Index count : {1, 2, 7, 300}) {
    const TriangleMesh mesh = randomSoup(GetParam(), count, 3);
    const TriangleTree tree(mesh);
    const Eigen::Matrix3Xd queries = randomPoints(200, 11, 2.f).cast<double>();
    const std::vector<ClosestPoint> together = closestPoints(tree, queries);
    for (Index i = 0; i < queries.cols(); ++i) {
      const Vector3d query = queries.col(i);
      const ClosestPoint expected = bruteForce(mesh, query), found = tree.closest(query);
      ASSERT_NEAR(found.distance, expected.distance, 1e-12) << count << " triangles, query " << i;
      EXPECT_NEAR((found.point - query).norm(), found.distance, 1e-12);
      EXPECT_NEAR(bruteForceDistance(mesh, found.face, query), found.distance, 1e-12); // the face is the one meant
      EXPECT_LT(bruteForceDistance(mesh, found.face, found.point), 1e-12);             // the point lies on it
      EXPECT_EQ(together[i].distance, found.distance);
      EXPECT_EQ(together[i].face, found.face);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, TriangleTreeSoup,
                         testing::Values(Soup::ordinary, Soup::needles, Soup::flat, Soup::points, Soup::clustered));

TEST(TriangleTree, ManyTrianglesAndThreadsGiveTheSame)
{
  const TriangleMesh mesh = randomSoup(Soup::ordinary, 40000, 5); // several subtrees
  const Eigen::Matrix3Xd queries = randomPoints(20000, 6, 1.5f).cast<double>();
  const std::vector<ClosestPoint> one = closestPoints(TriangleTree(mesh, 1), queries, 1);
  const std::vector<ClosestPoint> four = closestPoints(TriangleTree(mesh, 4), queries, 4);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].distance, four[i].distance);
    ASSERT_EQ(one[i].face, four[i].face);
    ASSERT_EQ(one[i].point, four[i].point);
  }
  for (Index i = 0; i < 50; ++i)
    EXPECT_NEAR(one[i].distance, bruteForce(mesh, queries.col(i)).distance, 1e-12);
}

TEST(TriangleTree, EqualDistancesGiveTheSmallestFace)
{
  TriangleMesh mesh = randomSoup(Soup::ordinary, 100, 9);
  const Points once = mesh.vertices;
  const Index n = mesh.faceCount();
  mesh.vertices.resize(3, 2 * once.cols());
  mesh.vertices << once, once; // every triangle twice
  mesh.faces = Eigen::VectorXi::LinSpaced(6 * n, 0, static_cast<int>(6 * n) - 1).reshaped(3, 2 * n);
  const TriangleTree tree(mesh);
  for (const ClosestPoint& closest : closestPoints(tree, randomPoints(500, 10, 2.f).cast<double>()))
    EXPECT_LT(closest.face, n);
}

TEST(TriangleTree, SearchRadiusLimits)
{
  TriangleMesh mesh;
  mesh.vertices.resize(3, 3);
  mesh.vertices << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  mesh.faces.resize(3, 1);
  mesh.faces << 0, 1, 2;
  const TriangleTree tree(mesh);
  const Vector3d query(0.25, 0.25, 3.0);
  EXPECT_EQ(tree.closest(query).distance, 3.0);
  EXPECT_EQ(tree.closest(query, 3.0).face, 0); // the radius itself counts
  EXPECT_EQ(tree.closest(query, 2.999).face, -1);
  EXPECT_TRUE(std::isinf(tree.closest(query, 2.999).distance));
  EXPECT_EQ(tree.closest({0.25, 0.25, 0.0}, 0.0).face, 0);
}

TEST(TriangleTree, CoordinatesFarFromZeroAndQueriesBetweenFloats)
{
  TriangleMesh mesh = randomSoup(Soup::ordinary, 500, 21);
  mesh.vertices.array() += 1e4f;
  const TriangleTree tree(mesh);
  Eigen::Matrix3Xd queries = randomPoints(300, 22, 1.5f).cast<double>();
  queries.array() += 1e4 + 1e-5; // cannot be told from 1e4 in single precision
  for (Index i = 0; i < queries.cols(); ++i)
    EXPECT_NEAR(tree.closest(queries.col(i)).distance, bruteForce(mesh, queries.col(i)).distance, 1e-11);
}

TEST(TriangleTree, HugeAndTinyCoordinates)
{
  for (const float scale : {1e-15f, 1e-6f, 1e6f, 1e15f}) {
    TriangleMesh mesh = randomSoup(Soup::ordinary, 200, 31);
    mesh.vertices *= scale;
    const TriangleTree tree(mesh);
    const Points queries = randomPoints(50, 32, 2.f * scale);
    for (Index i = 0; i < queries.cols(); ++i) {
      const Vector3d query = queries.col(i).cast<double>();
      EXPECT_NEAR(tree.closest(query).distance, bruteForce(mesh, query).distance, 1e-12 * scale);
    }
  }
}

TEST(TriangleTree, PointsAreFoundExactly)
{
  const Points points = randomPoints(2000, 41);
  const TriangleTree tree = TriangleTree::ofPoints(points);
  const Points queries = randomPoints(200, 42);
  for (Index i = 0; i < queries.cols(); ++i) {
    const Vector3d query = queries.col(i).cast<double>();
    Index nearest;
    const double expected =
        std::sqrt((points.cast<double>().colwise() - query).colwise().squaredNorm().minCoeff(&nearest));
    EXPECT_NEAR(tree.closest(query).distance, expected, 1e-14);
    EXPECT_EQ(tree.closest(query).face, nearest);
  }
}

TEST(TriangleTree, ManyEqualTrianglesDoNotDegenerate)
{
  TriangleMesh mesh;
  mesh.vertices.resize(3, 3);
  mesh.vertices << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  mesh.faces = Eigen::Vector3i(0, 1, 2).replicate(1, 20000);
  const TriangleTree tree(mesh);
  EXPECT_EQ(tree.closest({0.2, 0.2, 1.0}).face, 0);
  EXPECT_GT(tree.memory(), mesh.faceCount() * sizeof(Eigen::Vector3i));
}

TEST(TriangleTree, Errors)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TriangleMesh mesh = randomSoup(Soup::ordinary, 4, 51);
  const TriangleTree tree(mesh);
  EXPECT_THROW(tree.closest({0, 0, nan}), std::invalid_argument);
  EXPECT_THROW(tree.closest({0, 0, 1e19}), std::invalid_argument);
  EXPECT_THROW(tree.closest({0, 0, 0}, -1.0), std::invalid_argument);
  EXPECT_THROW(tree.closest({0, 0, 0}, nan), std::invalid_argument);
  EXPECT_THROW(closestPoints(tree, Eigen::Matrix3Xd::Constant(3, 2, nan)), std::invalid_argument);
  EXPECT_TRUE(closestPoints(tree, Eigen::Matrix3Xd(3, 0)).empty());
  EXPECT_THROW(TriangleTree{TriangleMesh{}}, std::invalid_argument);
  EXPECT_THROW(TriangleTree::ofPoints(Points(3, 0)), std::invalid_argument);
  EXPECT_THROW(TriangleTree::ofPoints(Points::Constant(3, 2, nan)), std::invalid_argument);
  TriangleMesh bad = mesh;
  bad.vertices(1, 4) = nan;
  EXPECT_THROW(TriangleTree{bad}, std::invalid_argument);
  bad = mesh;
  bad.vertices(1, 4) = 1e19f;
  EXPECT_THROW(TriangleTree{bad}, std::invalid_argument);
  bad = mesh;
  bad.faces(0, 0) = 100;
  EXPECT_THROW(TriangleTree{bad}, std::invalid_argument);
}

TEST(RayScene, RaysOutOfRangeHitNothing)
{
  TriangleMesh mesh;
  mesh.vertices = Points(3, 3);
  mesh.vertices << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  mesh.faces = Faces(3, 1);
  mesh.faces << 0, 1, 2;
  const RayScene scene(mesh);
  const float infinity = std::numeric_limits<float>::infinity();
  const Ray sound{{0.2f, 0.2f, 1.f}, {0.f, 0.f, -1.f}};
  RayPacket<16> packet;
  packet.fill(sound);
  std::size_t next = 1;
  for (const float wrong : {1e30f, -infinity, std::nanf("")})
    for (int axis = 0; axis < 3; ++axis) {
      Ray origin = sound, direction = sound;
      origin.origin[axis] = direction.direction[axis] = wrong;
      EXPECT_EQ(scene.intersect(origin).face, -1);
      EXPECT_EQ(scene.intersect(direction).face, -1);
      packet[next++] = axis % 2 ? origin : direction;
    }
  const HitPacket<16> hits = scene.intersect(packet, RayOrder::incoherent);
  for (std::size_t i = 0; i < 16; ++i)
    EXPECT_EQ(hits[i].face, i == 0 || i >= next ? 0 : -1) << i;
  EXPECT_EQ(scene.occluded(packet), 1U | (0xFFFFU << next & 0xFFFFU));
}
} // namespace
} // namespace fresco
