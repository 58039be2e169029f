// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_verification.h"
#include "registration/registration_scene.h"
#include <fresco/registration/core/point_to_plane_registration.h>
#include <gtest/gtest.h>
namespace fresco::registration {
namespace {
PreparedScan prepared(const PointSet& scan)
{
  return prepareScan(scan, Thinning(registrationVoxel(scan), scanSize(scan), narrowness(scan)), 1);
}

// The points in front of the scanner, as those of a camera.
PointSet narrowed(const PointSet& scan)
{
  PointSet narrow;
  narrow.viewpoints = scan.viewpoints;
  narrow.points.resize(3, scan.size());
  Index count = 0;
  for (Index i = 0; i < scan.size(); ++i)
    if (scan.points(0, i) > scan.points.col(i).tail<2>().norm())
      narrow.points.col(count++) = scan.points.col(i);
  narrow.points.conservativeResize(3, count);
  return narrow;
}

// Two scans of `boxes` at their true pose.
struct TruePair {
  TruePair(const test::Boxes& boxes, bool narrow)
  {
    for (int i = 0; i < 2; ++i) {
      const PointSet scan =
          test::scanBoxes(boxes, test::stationPose({1.0, 1.9 + 0.2 * i, 1.4}, 0.0, 0.0), 30000, 0.004, i + 1);
      scans.push_back(prepared(narrow ? narrowed(scan) : scan));
    }
    PoseHypothesis truth;
    truth.T_a_b = Eigen::Translation3d(0, 0.2, 0);
    truth.votes = many_votes;
    best = verifyHypothesis(geometry(), truth);
  }
  PairGeometry geometry() const { return {scans[0], scans[1]}; }

  std::vector<PreparedScan> scans;
  VerifiedHypothesis best;
};

TEST(PairCertainty, ARoomIsCertainAndAWallIsNot)
{
  test::Boxes wall;
  test::addBox(wall, {4.0, -20, -20}, {4.1, 20, 20});
  for (const bool narrow : {false, true}) {
    const TruePair room(test::twoRooms(), narrow);
    EXPECT_FALSE(isAmbiguous(room.geometry(), {room.best})) << narrow;
  }
  const TruePair sliding(wall, true);
  EXPECT_GT(sliding.best.check.overlap, 0.5);
  EXPECT_TRUE(sliding.best.has_free_motion);
  EXPECT_TRUE(isAmbiguous(sliding.geometry(), {sliding.best}));
}

TEST(PairCertainty, ContradictionOutweighsOverlapOfNarrowScans)
{
  TruePair room(test::twoRooms(), true);
  bool before = false;
  for (const double violation : {0.0, 0.005, 0.01, 0.02, 0.04}) {
    room.best.check.violation = violation;
    const bool ambiguous = isAmbiguous(room.geometry(), {room.best});
    EXPECT_GE(ambiguous, before) << violation; // more contradiction makes nothing certain
    before = ambiguous;
  }
  EXPECT_TRUE(before);
}

// Coarse noise makes true poses violate as well: 2.3 % of two scans of the lobby.
TEST(PairCertainty, ContradictionOfScansThatSawAroundIsNoChance)
{
  TruePair room(test::twoRooms(), false);
  room.best.check.violation = 0.023;
  EXPECT_FALSE(isAmbiguous(room.geometry(), {room.best}));
}

TEST(PairCertainty, PlanesAloneAreBelievedOfScansThatSawAround)
{
  for (const bool narrow : {false, true}) {
    TruePair room(test::twoRooms(), narrow);
    room.best.votes = 0;
    EXPECT_EQ(isAmbiguous(room.geometry(), {room.best}), narrow);
  }
}
} // namespace
} // namespace fresco::registration
