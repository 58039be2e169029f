// SPDX-License-Identifier: BSD-3-Clause
#include "filters/clouds.h"
#include <fresco/filters/bilateral_normal_filter.h>
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/oriented_normals.h>
#include <pcl/point_types.h>
#include <random>
namespace fresco {
namespace {
using Eigen::Vector3f;

struct Box {
  Vector3f low, high;
};

struct Hit {
  float range = std::numeric_limits<float>::infinity();
  Vector3f normal = Vector3f::Zero();
};

/// Where a beam from the origin enters the box.
Hit meet(const Box& box, const Vector3f& beam)
{
  Hit enter{0, Vector3f::Zero()};
  float leave = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const float a = box.low[axis] / beam[axis], b = box.high[axis] / beam[axis];
    if (std::min(a, b) > enter.range)
      enter = {std::min(a, b), beam[axis] > 0 ? Vector3f(-Vector3f::Unit(axis)) : Vector3f::Unit(axis)};
    leave = std::min(leave, std::max(a, b));
  }
  return enter.range > 0 && enter.range < leave ? enter : Hit{};
}

struct Scan {
  PointSet set; ///< seen from the origin
  Points truth;
  std::vector<Index> narrow; ///< points of the fronts of the boards
};

/// A wall with a rack of boards, 2 cm thick, before it: two or three beams meet the front of each.
/// @param lift of the boards, metres: which rows of beams meet what
Scan scanOfRack(float noise, unsigned seed, float lift = 0)
{
  std::vector<Box> boxes = {{{3, -9, -9}, {4, 9, 9}}, {{-9, -9, -2}, {9, 9, -1}}};
  for (int board = 0; board < 8; ++board)
    boxes.push_back({{2.7f, -1, lift - 0.6f + 0.17f * static_cast<float>(board)},
                     {3, 1, lift - 0.58f + 0.17f * static_cast<float>(board)}});
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal(0, noise);
  std::vector<Vector3f> points, normals;
  Scan scan;
  for (float azimuth = -0.45f; azimuth < 0.45f; azimuth += 0.004f)
    for (float elevation = -0.4f; elevation < 0.35f; elevation += 0.004f) {
      const Vector3f beam = Vector3f(1, std::tan(azimuth), std::tan(elevation)).normalized();
      Hit nearest;
      bool on_board = false;
      for (std::size_t b = 0; b < boxes.size(); ++b)
        if (const Hit hit = meet(boxes[b], beam); hit.range < nearest.range) {
          nearest = hit;
          on_board = b > 1;
        }
      if (on_board && nearest.normal.x() < -0.5f)
        scan.narrow.push_back(static_cast<Index>(points.size()));
      points.emplace_back((nearest.range + normal(generator)) * beam);
      normals.push_back(nearest.normal);
    }
  scan.set.points.resize(3, static_cast<Index>(points.size()));
  scan.truth.resize(3, scan.set.points.cols());
  for (std::size_t i = 0; i < points.size(); ++i) {
    scan.set.points.col(static_cast<Index>(i)) = points[i];
    scan.truth.col(static_cast<Index>(i)) = normals[i];
  }
  scan.set.viewpoints = Vector3f::Zero();
  return scan;
}

Points estimated(const PointSet& set) { return estimateNormals(set).normals; }

double meanAngleOf(const Points& normals, const Points& truth, const std::vector<Index>& which)
{
  double sum = 0;
  for (const Index i : which)
    sum += test::angleBetween(normals.col(i), truth.col(i));
  return sum / static_cast<double>(which.size());
}

struct Errors {
  double all_with = 0, all_without = 0, fronts_with = 0, fronts_without = 0; ///< mean angles, degrees
};

/// Of racks at ten heights: one row of beams more or less changes much.
Errors errorsOfRacks(float noise)
{
  Errors errors;
  for (unsigned k = 0; k < 10; ++k) {
    const Scan scan = scanOfRack(noise, 1 + k, 0.017f * static_cast<float>(k));
    const Points raw = estimated(scan.set);
    const Points with = smoothNormals(scan.set, raw).normals, without = smoothNormals(scan.set.points, raw).normals;
    EXPECT_GT(scan.narrow.size(), 1000u);
    errors.all_with += test::meanAngle(with, scan.truth) / 10;
    errors.all_without += test::meanAngle(without, scan.truth) / 10;
    errors.fronts_with += meanAngleOf(with, scan.truth, scan.narrow) / 10;
    errors.fronts_without += meanAngleOf(without, scan.truth, scan.narrow) / 10;
  }
  return errors;
}

TEST(CreaseNormals, BoardsGetTheDirectionsOfTheRoom)
{
  for (const float noise : {0.002f, 0.004f}) {
    const Errors errors = errorsOfRacks(noise);
    EXPECT_LT(errors.fronts_with, 0.8 * errors.fronts_without) << noise;
    EXPECT_LT(errors.all_with, 0.95 * errors.all_without) << noise;
  }
}

/// Without noise a lone row of beams on a board is on every plane through it.
TEST(CreaseNormals, ExactScansHardlyGetWorse)
{
  const Errors errors = errorsOfRacks(0);
  EXPECT_LT(errors.fronts_with, 0.8 * errors.fronts_without);
  EXPECT_LT(errors.all_with, 1.05 * errors.all_without);
}

TEST(CreaseNormals, DoesNotDependOnTheFrame)
{
  const Scan scan = scanOfRack(0.002f, 2);
  const Eigen::Isometry3f motion = test::someMotion();
  PointSet moved;
  moved.points = motion * scan.set.points;
  moved.viewpoints = motion.translation();
  const Points raw = estimated(scan.set);
  const double here = test::meanAngle(smoothNormals(scan.set, raw).normals, scan.truth);
  const double there =
      test::meanAngle(smoothNormals(moved, motion.linear() * raw).normals, motion.linear() * scan.truth);
  EXPECT_NEAR(there, here, 0.05 * here);
}

TEST(CreaseNormals, RoundThingsStayRound)
{
  const test::Cloud ball = test::unitSphere(20000, 3);
  const Vector3f viewer(0, 0, 4);
  std::vector<Index> seen;
  for (Index i = 0; i < ball.points.cols(); ++i)
    if (ball.normals.col(i).dot(viewer - ball.points.col(i)) > 0.3f)
      seen.push_back(i);
  Points truth(3, static_cast<Index>(seen.size()));
  for (std::size_t i = 0; i < seen.size(); ++i)
    truth.col(static_cast<Index>(i)) = ball.normals.col(seen[i]);
  for (const float noise : {0.f, 0.005f}) {
    PointSet all;
    all.points = test::withNoise(ball.points, noise, 4);
    PointSet set = selectPoints(all, seen);
    set.viewpoints = viewer;
    const Points raw = estimated(set);
    EXPECT_LT(test::meanAngle(smoothNormals(set, raw).normals, truth),
              1.02 * test::meanAngle(smoothNormals(set.points, raw).normals, truth) + 0.01);
  }
}

TEST(CreaseNormals, NeedsNormalsThatFaceTheViewer)
{
  const Scan scan = scanOfRack(0.002f, 5);
  const Points raw = estimated(scan.set);
  EXPECT_EQ(smoothNormals(scan.set, -raw).normals, smoothNormals(scan.set.points, -raw).normals);
  BilateralOptions off;
  off.edges = false;
  EXPECT_EQ(smoothNormals(scan.set, raw, off).normals, smoothNormals(scan.set.points, raw).normals);
  PointSet unknown = scan.set;
  unknown.viewpoints = Vector3f::Constant(test::nan);
  EXPECT_EQ(smoothNormals(unknown, raw).normals, smoothNormals(scan.set.points, raw).normals);
}

TEST(CreaseNormals, OneViewpointIsAsGoodAsOnePerPointAndThreadsDoNotCount)
{
  const Scan scan = scanOfRack(0.002f, 6);
  const Points raw = estimated(scan.set);
  BilateralOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const Points a = smoothNormals(scan.set, raw, one).normals;
  EXPECT_EQ(a, smoothNormals(scan.set, raw, four).normals);
  PointSet each = scan.set;
  each.viewpoints = Points::Zero(3, each.size());
  EXPECT_EQ(a, smoothNormals(each, raw, one).normals);
  each.viewpoints = Points::Zero(3, 2);
  EXPECT_THROW(smoothNormals(each, raw, one), std::invalid_argument);
}

TEST(CreaseNormals, FewPointsAndNonFiniteOnes)
{
  PointSet few;
  few.points = Points::Random(3, 5);
  few.viewpoints = Vector3f(0, 0, 9);
  Points up = Vector3f::UnitZ().replicate(1, 5);
  EXPECT_LT(test::meanAngle(smoothNormals(few, up).normals, up), 1e-3);
  few.points.col(2).setConstant(test::nan);
  up.col(3).setConstant(test::nan);
  const Points smooth = smoothNormals(few, up).normals;
  EXPECT_EQ(smooth.col(2), up.col(2));
  EXPECT_FALSE(smooth.col(3).allFinite());
  few.points.setZero();
  EXPECT_EQ(smoothNormals(few, Points::Ones(3, 5)).normals.cols(), 5);
  EXPECT_EQ(smoothNormals(PointSet{}, Points(3, 0)).normals.cols(), 0);
}

TEST(CreaseNormals, ClassIsTheCoreWhereAViewpointIsSet)
{
  const Scan scan = scanOfRack(0.002f, 7);
  const Points raw = estimated(scan.set);
  pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
  for (Index i = 0; i < scan.set.size(); ++i) {
    cloud->emplace_back(scan.set.points(0, i), scan.set.points(1, i), scan.set.points(2, i));
    cloud->back().getNormalVector3fMap() = raw.col(i);
  }
  BilateralNormalFilter<pcl::PointNormal> filter;
  filter.setInputCloud(cloud);
  const auto differing = [&](const Points& expected) {
    pcl::PointCloud<pcl::PointNormal> output;
    filter.filter(output);
    Index count = 0;
    for (Index i = 0; i < scan.set.size(); ++i)
      count += output[i].getNormalVector3fMap() != expected.col(i);
    return count;
  };
  const Points with = smoothNormals(scan.set, raw).normals, without = smoothNormals(scan.set.points, raw).normals;
  EXPECT_EQ(differing(without), 0);
  filter.setViewPoint(0, 0, 0);
  EXPECT_EQ(differing(with), 0);
  EXPECT_GT(differing(without), 0);
  filter.setViewPointUnknown();
  EXPECT_EQ(differing(without), 0);
}
} // namespace
} // namespace fresco
