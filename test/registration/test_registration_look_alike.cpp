// SPDX-License-Identifier: BSD-3-Clause
#include "pair/self_alignment.h"
#include "registration/look_alike_scenes.h"
#include <fresco/registration/core/point_to_plane_registration.h>
#include <gtest/gtest.h>
using namespace fresco::registration;
namespace fresco {
namespace {
using test::heldPairs;
using test::HeldPairs;
using test::LookAlikeScene;

struct Outcome {
  HeldPairs held;
  std::size_t placed = 0;
  ScanRegistrationResult result;
};

Outcome registered(const LookAlikeScene& place)
{
  Outcome outcome;
  outcome.result = registerScans(place.scene.scans);
  outcome.held = heldPairs(outcome.result, place.scene);
  for (const Pose& pose : outcome.result.poses)
    outcome.placed += pose ? 1 : 0;
  return outcome;
}

ScanAliases aliasesOf(const PointSet& set)
{
  const PreparedScan scan = prepareScan(set, {registrationVoxel(set), scanSize(set), narrowness(set)}, 0);
  return findAliases(scan, describeScan(scan, {}));
}

bool anyCertain(const ScanAliases& aliases)
{
  return std::any_of(aliases.begin(), aliases.end(), [](const ScanAlias& alias) { return alias.certain; });
}

// A corridor of equal bays maps onto itself by whole bays; by nothing else does it without contradiction.
TEST(SelfAlignment, EqualBaysAreFound)
{
  const LookAlikeScene place = test::bays({true, false});
  int found = 0;
  for (std::size_t i = 0; i < place.scene.scans.size(); ++i) {
    const ScanAliases aliases = aliasesOf(place.scene.scans[i]);
    found += anyCertain(aliases) ? 1 : 0;
    for (const ScanAlias& alias : aliases)
      if (alias.certain) {
        const double bays = alias.T.translation().norm() / 3.0;
        EXPECT_NEAR(bays, std::round(bays), 0.03);
        EXPECT_LT(Eigen::AngleAxisd(alias.T.linear()).angle(), 0.02);
      }
  }
  EXPECT_GE(found, 1);
}

TEST(SelfAlignment, FurnishedRoomsHaveNone)
{
  for (const PointSet& scan : test::scanTwoRooms(30000).scans)
    EXPECT_FALSE(anyCertain(aliasesOf(scan)));
  for (const PointSet& scan : test::bays({false, false}).scene.scans)
    EXPECT_FALSE(anyCertain(aliasesOf(scan)));
}

// What nothing tells apart is left in groups, and the report says why.
TEST(LookAlikes, EqualBaysAreNotMerged)
{
  const LookAlikeScene place = test::bays({true, false});
  const Outcome outcome = registered(place);
  EXPECT_EQ(outcome.held.wrong, 0);
  EXPECT_GT(outcome.result.groups, 1);
  for (std::size_t i = 0; i < place.scene.scans.size(); ++i)
    if (!outcome.result.poses[i]) {
      EXPECT_NE(outcome.result.scans[i].problem.find("look alike"), std::string::npos) << i;
    }
}

// Equal rooms that face each other: a scan from the corridor shows that there are two.
TEST(LookAlikes, EqualRoomsSeenFromBetweenAreNotMerged)
{
  for (const test::Paint paint : {test::Paint::none, test::Paint::same, test::Paint::different}) {
    const LookAlikeScene place = test::facingRooms({true, true, false, paint});
    EXPECT_EQ(registered(place).held.wrong, 0) << place.name;
  }
}

// Scans of equal rooms fit each other better than they fit the corridor, but only that one tells the rooms apart.
TEST(LookAlikes, EqualRoomsInARowAreNotMerged)
{
  for (const bool telling : {false, true}) {
    const LookAlikeScene place = test::roomsInARow(telling);
    const Outcome outcome = registered(place);
    EXPECT_EQ(outcome.held.wrong, 0) << place.name;
    if (telling) {
      EXPECT_EQ(outcome.placed, place.scene.scans.size()) << place.name;
    }
  }
}

// Without one, a scan of either room sees through both doors that a second room is equal.
TEST(LookAlikes, EqualRoomsThatSeeEachOtherAreNotMerged)
{
  for (const test::Paint paint : {test::Paint::none, test::Paint::different}) {
    const LookAlikeScene place = test::facingRooms({true, false, false, paint});
    const Outcome outcome = registered(place);
    EXPECT_EQ(outcome.held.wrong, 0) << place.name;
    if (paint == test::Paint::different)
      EXPECT_GE(outcome.held.right, 2) << place.name;
    else
      EXPECT_EQ(outcome.held.right, 0) << place.name;
  }
  for (const Index rays : {15000, 60000})
    EXPECT_EQ(registered(test::facingRooms({true, false, false, test::Paint::none}, rays)).held.wrong, 0) << rays;
}

TEST(SelfAlignment, EqualRoomsBehindDoorsArePartialAliases)
{
  Eigen::Isometry3d half_turn(Eigen::Translation3d(10, 4, 0) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  for (const bool equal : {true, false}) {
    const test::ScannedScene scene = test::facingRooms({equal, false, false, test::Paint::none}).scene;
    int partial = 0;
    for (std::size_t i = 0; i < scene.scans.size(); ++i)
      for (const ScanAlias& alias : aliasesOf(scene.scans[i]))
        if (alias.partial) {
          ++partial;
          const Eigen::Isometry3d moved = scene.truth[i] * alias.T * scene.truth[i].inverse();
          EXPECT_LT(poseDistance(moved, half_turn, 2.0), 0.5);
        }
    EXPECT_EQ(partial > 0, equal);
  }
}

// The counterparts that only seem to look alike are joined.
TEST(LookAlikes, WhatDiffersIsJoined)
{
  for (const LookAlikeScene& place :
       {test::bays({false, true}), test::facingRooms({true, true, true, test::Paint::none}),
        test::facingRooms({false, true, false, test::Paint::none})}) {
    const Outcome outcome = registered(place);
    EXPECT_EQ(outcome.placed, place.scene.scans.size()) << place.name;
    EXPECT_EQ(outcome.held.wrong, 0) << place.name;
  }
}
} // namespace
TEST(Thinning, SparseScansOfNarrowViewKeepFineLevels)
{
  const auto fan = [](float degrees) { // points all around, or in a fan of some degrees
    PointSet scan;
    scan.points.resize(3, 720);
    for (Index i = 0; i < scan.points.cols(); ++i) {
      const float angle = degrees * static_cast<float>(M_PI) / 180.f * (static_cast<float>(i) / 720.f - 0.5f);
      scan.points.col(i) << 3 * std::cos(angle), 3 * std::sin(angle), static_cast<float>(i % 7) - 3;
    }
    return scan;
  };
  const double wide = narrowness(fan(360)), narrow = narrowness(fan(60));
  EXPECT_LT(wide, 0.1);
  EXPECT_GT(narrow, 0.7);
  constexpr double size = 3, dense = size / voxels_per_size, sparse = 2 * dense;
  for (const double view : {wide, narrow})
    for (int k = 0; k < level_count; ++k)
      EXPECT_NEAR(Thinning(dense, size, view).voxels[k], dense * (1 << k), 1e-6);
  for (int k = 0; k < level_count; ++k)
    EXPECT_NEAR(Thinning(sparse, size, wide).voxels[k], sparse * (1 << k), 1e-6);
  const auto kept = Thinning(sparse, size, narrow).voxels;
  EXPECT_FLOAT_EQ(kept.front(), static_cast<float>(sparse));
  EXPECT_NEAR(kept.back(), Thinning(dense, size, narrow).voxels.back(), 1e-6);
}
} // namespace fresco
