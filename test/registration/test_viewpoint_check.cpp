// SPDX-License-Identifier: BSD-3-Clause
#include "graph/viewpoint_check.h"
#include "registration/registration_scene.h"
#include "scan/viewpoint_search.h"
#include <fresco/registration/core/scan_registration.h>
#include <gtest/gtest.h>
/// Files that do not tell where a scan was seen from.
namespace fresco::registration {
namespace {
const test::ScannedScene& scene()
{
  static const test::ScannedScene made = test::scanTwoRooms(30000);
  return made;
}

// A scan of the scene as a file without viewpoint holds it, moved in its own frame.
PointSet withoutViewpoint(Index scan, const Eigen::Vector3f& offset = Eigen::Vector3f::Zero())
{
  PointSet points = scene().scans[scan];
  points.viewpoints.resize(3, 0);
  points.points.colwise() += offset;
  return points;
}

ViewpointSign signOf(const PointSet& points)
{
  const double size = scanSize(points);
  return findViewpointSign(prepareScan(points, Thinning(size / voxels_per_size), 1), 1);
}

TEST(ViewpointSigns, PointsShowWhetherTheScannerStoodAtTheOrigin)
{
  EXPECT_EQ(signOf(withoutViewpoint(0)), ViewpointSign::center);
  EXPECT_EQ(signOf(withoutViewpoint(0, {0.6f, 0.5f, 0.f})), ViewpointSign::elsewhere);
  EXPECT_EQ(signOf(scene().scans[0]), ViewpointSign::none); // its file tells
}

// To look at one place alone finds it less often than a search does, but nothing else.
TEST(ViewpointSigns, OnlyTheScannersPlaceIsItsViewpoint)
{
  int shown = 0;
  for (std::size_t i = 0; i < scene().scans.size(); ++i) {
    const PointSet scan = withoutViewpoint(i);
    const auto size = static_cast<float>(scanSize(scan));
    shown += isViewpoint(scan.points, Eigen::Vector3f::Zero(), size, 1) ? 1 : 0;
    for (const Eigen::Vector3f& wrong : {Eigen::Vector3f(0.5f, 0.3f, 0.f), Eigen::Vector3f(-0.4f, 0.6f, 0.1f)})
      EXPECT_FALSE(isViewpoint(scan.points, wrong, size, 1)) << i;
  }
  EXPECT_GE(shown, 1);
}

TEST(ViewpointSigns, ScansThatShowNothingFollowMostOthers)
{
  const auto found = [](const std::vector<ViewpointSign>& signs) {
    std::vector<PreparedScan> scans(signs.size(), prepareScan(withoutViewpoint(0), Thinning(0.02), 1));
    confirmViewpoints(scans, signs);
    std::vector<bool> result;
    for (const PreparedScan& scan : scans)
      result.push_back(scan.viewpoint_found);
    return result;
  };
  constexpr auto none = ViewpointSign::none, center = ViewpointSign::center, elsewhere = ViewpointSign::elsewhere;
  EXPECT_EQ(found({center, none, center}), std::vector<bool>({true, true, true}));
  EXPECT_EQ(found({center, none, none}), std::vector<bool>({true, false, false}));
  EXPECT_EQ(found({center, elsewhere, center}), std::vector<bool>({true, false, true}));
}

// The scanner at the frame's origin: told by the file or shown by the points, all comes out the same.
TEST(ViewpointSigns, WhatPointsShowIsAsGoodAsWhatFilesTell)
{
  std::vector<PointSet> scans;
  for (std::size_t i = 0; i < scene().scans.size(); ++i)
    scans.push_back(withoutViewpoint(i));
  const auto told = registerScans(scene().scans), shown = registerScans(scans);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(told.poses[i], shown.poses[i]) << i;
    EXPECT_TRUE(shown.scans[i].viewpoint_problem.empty()) << i;
  }
}
} // namespace
} // namespace fresco::registration
