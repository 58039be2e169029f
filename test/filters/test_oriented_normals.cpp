// SPDX-License-Identifier: BSD-3-Clause
#include "filters/clouds.h"
#include <fresco/filters/core/normal_orientation.h>
#include <fresco/filters/core/oriented_normals.h>
#include <fresco/io/point_io.h>
namespace fresco {
namespace {
using test::Cloud;
using test::nan;

PointSet seenFrom(const Points& points, const Eigen::Vector3f& viewpoint)
{
  PointSet set;
  set.points = points;
  set.viewpoints = viewpoint;
  return set;
}

PointSet unseen(const Points& points)
{
  PointSet set;
  set.points = points;
  return set;
}

TEST(OrientedNormals, ExactOnAPlaneAndTowardsTheViewpoint)
{
  const Cloud flat = test::flatSquare(3000, 1);
  for (const bool edges : {false, true})
    for (const float radius : {0.f, 0.1f}) {
      NormalOptions options;
      options.edges = edges;
      options.radius = radius;
      const NormalField up = estimateNormals(seenFrom(flat.points, {0.3f, 0, 5}), options);
      const NormalField down = estimateNormals(seenFrom(flat.points, {0, 0, -0.1f}), options);
      for (Index i = 0; i < flat.points.cols(); ++i) {
        EXPECT_LT(test::angleBetween(up.normals.col(i), flat.normals.col(i)), 0.02f);
        EXPECT_LT(test::angleBetween(down.normals.col(i), -flat.normals.col(i)), 0.02f);
        EXPECT_LT(up.curvatures[i], 1e-5f);
      }
    }
}

TEST(OrientedNormals, ConvergeOnASphere)
{
  double before = 90;
  for (const Index count : {500, 2000, 8000, 32000}) {
    const Cloud ball = test::unitSphere(count, 2);
    PointSet set = unseen(ball.points);
    set.viewpoints = 2 * ball.points;
    const double error = test::meanAngle(estimateNormals(set).normals, ball.normals);
    EXPECT_LT(error, 0.65 * before) << count; // second order in the spacing would be 0.5
    before = error;
  }
  EXPECT_LT(before, 1.0);
}

TEST(OrientedNormals, StayOnOneSideOfAnEdge)
{
  const Cloud cube = test::cube(40000, 3);
  PointSet set = unseen(cube.points);
  set.viewpoints = 3 * cube.points;
  NormalOptions plain;
  plain.edges = false;
  const Points with = estimateNormals(set).normals, without = estimateNormals(set, plain).normals;
  double error_with = 0, error_without = 0, elsewhere = 0;
  for (Index i = 0; i < set.size(); ++i)
    if (test::edgeDistance(cube.points.col(i)) < 0.03f) {
      error_with += test::angleBetween(with.col(i), cube.normals.col(i));
      error_without += test::angleBetween(without.col(i), cube.normals.col(i));
    } else if (test::edgeDistance(cube.points.col(i)) > 0.1f) {
      elsewhere = std::max<double>(elsewhere, test::angleBetween(with.col(i), cube.normals.col(i)));
    }
  EXPECT_LT(error_with, 0.2 * error_without);
  EXPECT_LT(elsewhere, 0.1);
}

/// Where variances are those of rounding alone, no plane is flatter than another.
TEST(OrientedNormals, FacesWithoutNoiseStayExact)
{
  const Cloud cube = test::cube(40000, 3);
  PointSet set = unseen(cube.points);
  set.viewpoints = 3 * cube.points;
  const Points normals = estimateNormals(set).normals;
  Index turned = 0, faces = 0;
  for (Index i = 0; i < set.size(); ++i)
    if (test::edgeDistance(cube.points.col(i)) > 0.02f) {
      turned += test::angleBetween(normals.col(i), cube.normals.col(i)) > 0.1f;
      ++faces;
    }
  EXPECT_LE(turned, faces / 1000);
}

TEST(OrientedNormals, EdgesStayWithNoise)
{
  const Cloud cube = test::cube(40000, 3);
  PointSet set = unseen(test::withNoise(cube.points, 0.004f, 8));
  set.viewpoints = 3 * cube.points;
  NormalOptions plain;
  plain.edges = false;
  const double with = test::meanAngle(estimateNormals(set).normals, cube.normals);
  const double without = test::meanAngle(estimateNormals(set, plain).normals, cube.normals);
  EXPECT_LT(with, 0.9 * without);
}

/// Two walls of 1 x 1 that meet at a right angle along the y axis, seen from `eye`, with noise along the rays: share of
/// the points within 2 cm of the crease whose normal is not that of their wall.
double wrongBesideCrease(const Eigen::Vector3f& eye, bool rays_known)
{
  constexpr int side = 70;
  Points points(3, 2 * side * side), truth(3, points.cols());
  const Points noise = test::randomPoints(points.cols(), 11);
  for (Index i = 0; i < points.cols(); ++i) {
    const float u = (static_cast<float>(i % side) + 0.5f) / side, v = static_cast<float>(i / side % side) / side;
    const bool floor = i < side * side;
    const Eigen::Vector3f at = floor ? Eigen::Vector3f(u, v, 0) : Eigen::Vector3f(0, v, u);
    const float along = 0.005f * noise.col(i).sum();
    points.col(i) = at + along * (at - eye).normalized();
    truth.col(i) = floor ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitX();
  }
  PointSet set = unseen(points);
  if (rays_known)
    set.viewpoints = eye;
  const Points normals = estimateNormals(set).normals;
  double wrong = 0, all = 0;
  for (Index i = 0; i < points.cols(); ++i)
    if ((i % side + 0.5) / side < 0.02) {
      wrong += std::abs(normals.col(i).dot(truth.col(i))) < 0.9f;
      ++all;
    }
  return wrong / all;
}

TEST(OrientedNormals, TheRayTellsTheSidesOfACrease)
{
  for (const Eigen::Vector3f& eye :
       {Eigen::Vector3f(1.5f, 0.5f, 1.7f), Eigen::Vector3f(-1.5f, 0.5f, -1.7f)}) // a hollow, a ridge
    EXPECT_LT(wrongBesideCrease(eye, true), 0.7 * wrongBesideCrease(eye, false));
}

/// Sixteen nearest points closer together than the noise is thick would give directions at random, 57 degrees off.
TEST(OrientedNormals, DenseNoisyScansGetNormalsOfTheSurface)
{
  const Cloud flat = test::flatSquare(40000, 3);
  const Points noisy = test::withNoise(flat.points, 0.01f, 4);
  EXPECT_LT(test::meanAngle(estimateNormals(seenFrom(noisy, {0, 0, 5})).normals, flat.normals), 15);
}

/// A ceiling seen from a scanner that turns about the vertical: close to the axis the sixteen nearest beams are of one
/// row, and with their noise span a plane upright on the surface.
TEST(OrientedNormals, RowsOfBeamsHaveThePlaneOfTheirSurface)
{
  constexpr float step = 0.008f, height = 2;
  constexpr int rows = 60, columns = 785;
  for (const float noise : {0.0005f, 0.002f, 0.005f}) {
    std::mt19937 generator(5);
    std::normal_distribution<float> along_beam(0, noise);
    Points points(3, rows * columns);
    for (Index i = 0; i < points.cols(); ++i) {
      const float away = step * (static_cast<float>(i / columns) + 0.5f),
                  azimuth = step * static_cast<float>(i % columns);
      const Eigen::Vector3f beam(std::tan(away) * std::cos(azimuth), std::tan(away) * std::sin(azimuth), 1);
      points.col(i) = height * beam + along_beam(generator) * beam.normalized();
    }
    for (const bool edges : {false, true}) {
      NormalOptions options;
      options.edges = edges;
      const Points normals = estimateNormals(seenFrom(points, {0, 0, 0}), options).normals;
      Index off = 0;
      for (Index i = 0; i < points.cols(); ++i)
        off += test::angleBetween(normals.col(i), -Eigen::Vector3f::UnitZ()) > 45;
      EXPECT_LE(off, edges ? points.cols() / 10000 : 0) << noise;
    }
  }
}

/// A rod of a single row of beams has no plane of its own; that of the wall behind it is none of its.
TEST(OrientedNormals, RodsDoNotTakeTheWallBehind)
{
  constexpr int side = 100, length = 300;
  const Eigen::Vector3f along = Eigen::Vector3f(0, 1, 0.5f).normalized();
  Points points(3, side * side + length);
  for (Index i = 0; i < side * side; ++i)
    points.col(i) << 0.01f * static_cast<float>(i % side - side / 2), 0.01f * static_cast<float>(i / side - side / 2),
        0;
  for (Index i = 0; i < length; ++i)
    points.col(side * side + i) = Eigen::Vector3f(0, -0.4f, 0.05f) + 0.002f * static_cast<float>(i) * along;
  const Points normals = estimateNormals(seenFrom(test::withNoise(points, 0.002f, 6), {0, 0, 3})).normals;
  for (Index i = side * side; i < points.cols(); ++i)
    EXPECT_LT(std::abs(normals.col(i).dot(along)), 0.4f) << i - side * side;
}

TEST(OrientedNormals, WithoutViewpointClosedObjectsPointOutward)
{
  for (const float noise : {0.f, 0.01f}) {
    for (const Cloud& cloud : {test::unitSphere(6000, 5), test::cube(9000, 6)}) {
      Points two(3, 2 * cloud.points.cols()), truth(3, two.cols());
      two << test::withNoise(cloud.points, noise, 1), cloud.points.colwise() + Eigen::Vector3f(5, 0, 1);
      truth << cloud.normals, cloud.normals;
      const Points normals = estimateNormals(unseen(two)).normals;
      Index wrong = 0;
      for (Index i = 0; i < two.cols(); ++i)
        wrong += normals.col(i).dot(truth.col(i)) < -0.3f;
      EXPECT_LE(wrong, noise > 0 ? two.cols() / 1000 : 0);
    }
  }
}

TEST(OrientedNormals, TwoSidesOfAThinSheetStayApart)
{
  const Cloud flat = test::flatSquare(8000, 7);
  PointSet set = unseen(flat.points);
  set.viewpoints = Points::Zero(3, set.size());
  for (Index i = 0; i < set.size(); ++i) {
    set.points(2, i) = i % 2 ? 0.08f : 0.f;
    set.viewpoints(2, i) = i % 2 ? 2.f : -2.f;
  }
  const Points normals = estimateNormals(set).normals;
  for (Index i = 0; i < set.size(); ++i)
    EXPECT_GT(normals(2, i) * (i % 2 ? 1 : -1), 0.f);
}

TEST(OrientedNormals, MoveWithTheInput)
{
  const Cloud cube = test::cube(5000, 9);
  const Eigen::Isometry3f motion = test::someMotion();
  const Points noisy = test::withNoise(cube.points, 0.003f, 2);
  const Points moved = (motion.linear() * noisy).colwise() + motion.translation();
  NormalOptions plain;
  plain.edges = false; // the choice of a plane at an edge may tip over with a rounding error
  const Points a = estimateNormals(seenFrom(noisy, {0, 0, 9}), plain).normals;
  const Points b = estimateNormals(seenFrom(moved, motion * Eigen::Vector3f(0, 0, 9)), plain).normals;
  Index turned = 0;
  for (Index i = 0; i < a.cols(); ++i)
    turned += test::angleBetween(motion.linear() * a.col(i), b.col(i)) > 0.1f;
  EXPECT_LE(turned, 5); // 16 neighbours may change where two points are equally far
}

TEST(OrientedNormals, DoNotDependOnThreads)
{
  const Points points = test::withNoise(test::cube(20000, 9).points, 0.003f, 2);
  for (const PointSet& set : {seenFrom(points, {0, 0, 9}), unseen(points)})
    for (const float radius : {0.f, 0.05f}) {
      NormalOptions one, four;
      one.radius = four.radius = radius;
      one.threads = 1;
      four.threads = 4;
      const NormalField a = estimateNormals(set, one), b = estimateNormals(set, four);
      EXPECT_TRUE(test::same(a.normals, b.normals));
      EXPECT_TRUE(test::same(a.curvatures, b.curvatures));
      EXPECT_TRUE(test::same(a.confidences, b.confidences));
    }
}

TEST(OrientedNormals, DegenerateNeighborhoods)
{
  const NormalField none = estimateNormals(unseen(Points(3, 0)));
  EXPECT_EQ(none.normals.cols(), 0);
  const NormalField one = estimateNormals(unseen(Points::Zero(3, 1)));
  EXPECT_TRUE(std::isnan(one.normals(0, 0)));
  EXPECT_EQ(one.confidences[0], 0.f);
  const NormalField seen = estimateNormals(seenFrom(Points::Zero(3, 50), {0, 0, 2}));
  EXPECT_EQ(seen.normals.col(7), Eigen::Vector3f::UnitZ());
  Points line = Points::Zero(3, 60);
  line.row(0) = Eigen::RowVectorXf::LinSpaced(60, 0, 1);
  const NormalField on_line = estimateNormals(seenFrom(line, {0.5f, 3, 0}));
  EXPECT_LT(test::angleBetween(on_line.normals.col(3), Eigen::Vector3f::UnitY()), 0.1f);
  EXPECT_TRUE(estimateNormals(unseen(line)).normals.array().isNaN().all());
  NormalOptions many;
  many.k = 500; // more than there are points
  EXPECT_NEAR(estimateNormals(seenFrom(test::flatSquare(30, 1).points, {0, 0, 1}), many).normals(2, 4), 1, 1e-5);
}

TEST(OrientedNormals, NonFinitePointsGetNanAndDoNotSpread)
{
  Cloud flat = test::flatSquare(1000, 1);
  for (Index i = 0; i < 1000; i += 3)
    flat.points(i % 2, i) = i % 4 ? nan : std::numeric_limits<float>::infinity();
  for (const PointSet& set : {seenFrom(flat.points, {0, 0, 1}), unseen(flat.points)}) {
    const NormalField field = estimateNormals(set);
    for (Index i = 0; i < 1000; ++i) {
      EXPECT_EQ(field.normals.col(i).allFinite(), i % 3 != 0);
      EXPECT_EQ(field.confidences[i] > 0, i % 3 != 0);
    }
  }
}

TEST(OrientedNormals, ConfidenceFallsAtGrazingIncidenceAndForLonePoints)
{
  Cloud flat = test::flatSquare(4000, 1);
  flat.points.col(0) << 0, 0, 3;
  const NormalField field = estimateNormals(seenFrom(flat.points, {-1, 0, 0.2f}));
  double near = 0, far = 0;
  for (Index i = 1; i < 4000; ++i)
    (flat.points(0, i) < -0.8f ? near : far) +=
        flat.points(0, i) < -0.8f || flat.points(0, i) > 0.8f ? field.confidences[i] : 0;
  EXPECT_GT(near, 2 * far);
  EXPECT_LT(field.confidences[0], 0.01f);
  EXPECT_LE(field.confidences.maxCoeff(), 1.f);
}

TEST(OrientedNormals, ImagesGiveTheSameAsTheTree)
{
  const Index width = 160, height = 120;
  Points image(3, width * height);
  for (Index i = 0; i < image.cols(); ++i) {
    const float x = static_cast<float>(i % width - width / 2) / 100,
                y = static_cast<float>(i / width - height / 2) / 100;
    const float z = x < 0 ? 2.f : 2.f / (1 + 0.8f * x); // a wall, then one that comes closer
    image.col(i) = z * Eigen::Vector3f(x, y, 1);
  }
  NormalOptions options;
  const NormalField tree = estimateNormals(seenFrom(image, {0, 0, 0}), options);
  options.image_width = width;
  const NormalField grid = estimateNormals(seenFrom(image, {0, 0, 0}), options);
  EXPECT_LT(test::meanAngle(grid.normals, tree.normals), 0.1);
  options.image_width = 7;
  EXPECT_THROW(estimateNormals(seenFrom(image, {0, 0, 0}), options), std::invalid_argument);
}

TEST(OrientedNormals, RejectsOptionsOutOfRange)
{
  const PointSet set = seenFrom(test::flatSquare(20, 1).points, {0, 0, 1});
  NormalOptions options;
  for (const int k : {2, 1001}) {
    options.k = k;
    EXPECT_THROW(estimateNormals(set, options), std::invalid_argument);
  }
  options = {};
  options.radius = nan;
  EXPECT_THROW(estimateNormals(set, options), std::invalid_argument);
  EXPECT_THROW(estimateNormals(seenFrom(set.points, {0, nan, 0})), std::invalid_argument);
  PointSet wrong = set;
  wrong.viewpoints = Points::Zero(3, 2);
  EXPECT_THROW(estimateNormals(wrong), std::invalid_argument);
  EXPECT_THROW(estimateNormals(set, {}, [](auto, double) { return false; }), Cancelled);
}

TEST(OrientedNormals, RealScansOfAnApartment)
{
  FRESCO_NEED_DATA("apartment/cloud.00000.vtk");
  PointSet set = readPoints(test::dataFolder() + "/apartment/cloud.00000.vtk");
  set.viewpoints = (-set.origin).cast<float>();
  const NormalField field = estimateNormals(set);
  Index vertical = 0;
  for (Index i = 0; i < set.size(); ++i) {
    EXPECT_NEAR(field.normals.col(i).norm(), 1.f, 1e-4f);
    EXPECT_GE(field.normals.col(i).dot(set.viewpoints.col(0) - set.points.col(i)), 0.f);
    const float up = std::abs(field.normals(2, i));
    vertical += up < 0.17f || up > 0.985f; // walls, floor and ceiling within 10 degrees
  }
  EXPECT_GT(vertical, set.size() / 3);
}
} // namespace
} // namespace fresco
