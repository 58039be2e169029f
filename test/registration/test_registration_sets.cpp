// SPDX-License-Identifier: BSD-3-Clause
#include "registration/look_alike_scenes.h"
#include "test_data.h"
#include <algorithm>
#include <fresco/core/progress.h>
#include <fresco/registration/core/scan_registration.h>
#include <numeric>
/// Sets of scans as they come: broken files, copies, large coordinates, a map that grows.
namespace fresco {
namespace {
using test::relativeError;
using test::ScannedScene;

const ScannedScene& scene()
{
  static const ScannedScene made = test::scanTwoRooms(30000);
  return made;
}

bool mentions(const std::vector<std::string>& lines, const std::string& a, const std::string& b)
{
  return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
    return line.find(a) != std::string::npos && line.find(b) != std::string::npos;
  });
}

/// The scans of a scene, of which `broken` cannot be read and `empty` has no points.
ScanSource damagedSource(Index broken, Index empty)
{
  return {5, [=](Index i) {
            if (i == broken)
              throw std::runtime_error("c.pcd: truncated");
            return i == empty ? PointSet{} : scene().scans[i];
          }};
}

TEST(ScanSets, BrokenAndEmptyScansAreLeftOutAndNamed)
{
  ScanRegistrationOptions options;
  options.names = {"a.pcd", "b.pcd", "c.pcd", "d.pcd", "e.pcd"};
  const auto result = registerScans(damagedSource(2, 4), {}, options);
  for (const Index i : {0, 1, 3})
    EXPECT_TRUE(result.poses[i].has_value()) << i;
  EXPECT_FALSE(result.poses[2] || result.poses[4]);
  EXPECT_LT(relativeError(result.poses, scene()).translation, 0.005);
  const auto warnings = registrationWarnings(result, options);
  EXPECT_TRUE(mentions(warnings, "c.pcd: left out: truncated", ""));
  EXPECT_TRUE(mentions(warnings, "e.pcd", "0 finite points"));
}

TEST(ScanSets, StoppingIsNotABrokenScan)
{
  const ScanSource source{2, [](Index) -> PointSet { throw Cancelled(); }};
  EXPECT_THROW(registerScans(source), Cancelled);
}

TEST(ScanSets, NothingIsPlacedIfNoScanCanBeRead)
{
  const ScanSource source{2, [](Index) -> PointSet { throw std::runtime_error("damaged"); }};
  const auto result = registerScans(source);
  EXPECT_EQ(result.groups, 0);
  EXPECT_FALSE(result.poses[0] || result.poses[1]);
}

TEST(ScanSets, CopiesLieOnEachOtherAndAreNamed)
{
  const auto result = registerScans({scene().scans[0], scene().scans[1], scene().scans[0]});
  ASSERT_TRUE(result.poses[0] && result.poses[2]);
  EXPECT_EQ(*result.poses[0], *result.poses[2]);
  EXPECT_EQ(result.scans[2].duplicate_of, 0);
  EXPECT_EQ(result.scans[0].duplicate_of, -1);
  EXPECT_TRUE(mentions(registrationWarnings(result, {}), "scan 2", "same points as scan 0"));
}

// Two in one building, three in another: which are the other three is said.
TEST(ScanSets, SecondBuildingIsNamed)
{
  test::Boxes other;
  test::addRoom(other, {0, 0, 0}, {7, 3, 3.2}, std::numeric_limits<double>::quiet_NaN());
  test::addFurniture(other, {0.5, 0.5, 0}, {6.5, 2.5, 0}, 6, 21);
  std::vector<PointSet> scans(scene().scans.begin(), scene().scans.begin() + 3);
  for (const double x : {1.5, 3.0})
    scans.push_back(test::scanBoxes(other, test::stationPose({x, 1.4, 1.5}, x, 0), 30000, 0.004, 9));
  const auto result = registerScans(scans);
  EXPECT_EQ(result.groups, 2);
  EXPECT_TRUE(mentions(registrationWarnings(result, {}), "another group: 2 scans", "scan 3, scan 4"));
}

/// Coloured scans of one room, each moved to `offset` in its own frame, as georeferenced files are; seen from its scanner
/// or from an unknown place.
ScannedScene georeferenced(const Eigen::Vector3d& offset, bool viewpoint)
{
  const test::Boxes boxes = test::twoRooms();
  std::vector<unsigned> numbers(boxes.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  ScannedScene moved = scene();
  moved.scans.resize(3);
  for (std::size_t i = 0; i < moved.scans.size(); ++i) {
    test::paint(moved.scans[i], moved.truth[i], boxes, numbers);
    moved.scans[i].origin = offset;
    if (!viewpoint)
      moved.scans[i].viewpoints.resize(3, 0);
    moved.truth[i] = moved.truth[i] * Eigen::Translation3d(-offset);
  }
  return moved;
}

/// Point 7 of a scan where its pose puts it.
Eigen::Vector3d placedPoint(const PointSet& scan, const Pose& pose)
{
  return Eigen::Isometry3d(*pose) * (scan.origin + scan.points.col(7).cast<double>());
}

TEST(ScanSets, LargeCoordinatesAreRegisteredAndMergedExactly)
{
  for (const bool viewpoint : {true, false})
    for (const Eigen::Vector3d& offset : {Eigen::Vector3d(40, 0, 0), Eigen::Vector3d(500000, 5000000, 300)}) {
      const ScannedScene moved = georeferenced(offset, viewpoint);
      const auto result = registerScans(moved.scans);
      const PointSet merged = mergeScans(moved.scans, result.poses);
      Index at = 7;
      for (std::size_t i = 0; i < 3; at += moved.scans[i++].size()) {
        ASSERT_TRUE(result.poses[i].has_value()) << offset.transpose() << " viewpoint " << viewpoint;
        const Eigen::Vector3d found = placedPoint(moved.scans[i], result.poses[i]);
        const Eigen::Isometry3d T_found_true(*result.poses[0] * moved.truth[0].inverse().matrix());
        EXPECT_LT((found - T_found_true * placedPoint(moved.scans[i], Pose(moved.truth[i].matrix()))).norm(), 0.005)
            << offset.transpose() << " viewpoint " << viewpoint;
        EXPECT_LT((merged.origin + merged.points.col(at).cast<double>() - found).norm(), 1e-5);
      }
    }
}

// From the true place no surface lies behind another one; in an empty room that is so from everywhere.
TEST(ScanSets, ScannerIsFoundWhereItsSurfacesTell)
{
  const Eigen::Vector3d offset(500000, 5000000, 300);
  const auto furnished = registerScans(georeferenced(offset, false).scans);
  for (const ScanResult& scan : furnished.scans) {
    ASSERT_TRUE(scan.found_viewpoint.has_value());
    EXPECT_LT((*scan.found_viewpoint - offset).norm(), 0.4); // boxes have few edges that tell
  }
  test::Boxes empty;
  test::addRoom(empty, {0, 0, 0}, {4, 5, 2.6}, std::numeric_limits<double>::quiet_NaN());
  std::vector<PointSet> scans;
  for (const double x : {1.0, 2.5}) {
    scans.push_back(test::scanBoxes(empty, test::stationPose({x, 2, 1.5}, x, 0.02), 20000, 0.004, 3));
    scans.back().origin = offset;
    scans.back().viewpoints.resize(3, 0);
  }
  const auto result = registerScans(scans);
  EXPECT_FALSE(result.scans[0].found_viewpoint || result.scans[1].found_viewpoint);
  EXPECT_FALSE(result.poses[0] && result.poses[1]);
}

TEST(ScanSets, FixedScansStayToTheLastBit)
{
  ScanRegistrationOptions options;
  options.fixed = true;
  std::vector<Pose> start;
  for (const Pose& pose : test::disturbed(scene(), 0.0005, 0.01))
    start.push_back(pose);
  start[1].reset();
  start[4].reset();
  const auto result = registerScans(scene().scans, start, options);
  for (const Index i : {0, 2, 3})
    EXPECT_EQ(*result.poses[i], *start[i]);
  ASSERT_TRUE(result.poses[1] && result.poses[4]);
  EXPECT_LT(relativeError(result.poses, scene()).translation, 0.01);
  for (const PairResult& pair : result.pairs)
    EXPECT_FALSE(start[pair.a] && start[pair.b]) << "fixed scans were compared";
  EXPECT_THROW(registerScans(scene().scans, {}, options), std::invalid_argument);
}

// Old scans of a place apart from a new one: nothing moves, and the new one is alone.
TEST(ScanSets, WhatDoesNotFitTheFixedScansIsNotPlaced)
{
  ScanRegistrationOptions options;
  options.fixed = true;
  test::Boxes other;
  test::addRoom(other, {0, 0, 0}, {7, 3, 3.2}, std::numeric_limits<double>::quiet_NaN());
  test::addFurniture(other, {0.5, 0.5, 0}, {6.5, 2.5, 0}, 6, 21);
  const PointSet foreign = test::scanBoxes(other, test::stationPose({2, 1.5, 1.5}, 0.4, 0), 30000, 0.004, 9);
  const Pose old = scene().truth[0].matrix();
  const auto result = registerScans({foreign, scene().scans[0]}, {Pose(), old}, options);
  EXPECT_EQ(*result.poses[1], *old);
  EXPECT_FALSE(result.poses[0].has_value());
}
} // namespace
} // namespace fresco
