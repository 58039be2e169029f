// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/part_check.h"
#include "assembly/scan_assembly.h"
#include "graph/equal_rooms.h"
#include "registration/look_alike_scenes.h"
#include <fresco/registration/core/point_to_plane_registration.h>
#include <gtest/gtest.h>
namespace fresco::registration {
namespace {
// Scans at their true poses, and pairs of them.
struct Scene {
  test::ScannedScene scanned;
  std::vector<PreparedScan> scans;
  std::vector<PairAlignment> pairs;
  GraphOptions options;

  explicit Scene(test::ScannedScene scene) : scanned(std::move(scene))
  {
    const PointSet& first = scanned.scans.front();
    const Thinning thinning(registrationVoxel(first), scanSize(first), narrowness(first));
    for (const PointSet& scan : scanned.scans)
      scans.push_back(prepareScan(scan, thinning, 0));
    options.tolerance = 4.f * thinning.voxels[0];
  }
  Eigen::Isometry3d pose(Index a, Index b) const { return scanned.truth[a].inverse() * scanned.truth[b]; }
  GraphInput input() const { return {scans, pairs, options}; }

  // As if nothing contradicted it.
  void addPair(Index a, Index b, const Eigen::Isometry3d& T_a_b, double overlap)
  {
    VerifiedHypothesis hypothesis;
    hypothesis.T_a_b = T_a_b;
    hypothesis.check.overlap = hypothesis.support = hypothesis.score = overlap;
    pairs.push_back({a, b, {hypothesis}, false, {}});
  }
};

// A scan of a third room that fits in both of two equal ones shows that there are two: scans that were joined by their
// likeness are parted.
TEST(ClusterJoins, WhatFitsInTwoEqualRoomsPartsThem)
{
  constexpr Index room_a = 0, door_a = 1, room_b = 2, door_b = 3, room_c = 4;
  for (const bool witness : {false, true}) {
    Scene scene(test::roomsInARow(false).scene);
    const auto shifted = [&](Index room, int rooms) {
      return Eigen::Isometry3d(Eigen::Translation3d(0, rooms * test::row_pitch, 0) * scene.scanned.truth[room]);
    };
    scene.addPair(room_a, room_b, shifted(room_a, 1).inverse() * scene.scanned.truth[room_b], 0.9);
    scene.addPair(door_a, door_b, scene.pose(door_a, door_b), 0.6);
    scene.addPair(room_b, door_b, scene.pose(room_b, door_b), 0.3);
    if (witness) {
      scene.addPair(door_b, room_c, scene.scanned.truth[door_b].inverse() * shifted(room_c, -1), 0.3);
      scene.addPair(door_a, room_c, scene.scanned.truth[door_a].inverse() * shifted(room_c, -2), 0.3);
    }
    const ScanGraph graph = assembleScans(scene.input());
    const std::vector<ClusterPlace> places = placesOf(graph.clusters, scene.scans.size());
    EXPECT_EQ(places[room_a].cluster == places[room_b].cluster, !witness);
  }
}

// In the frame of the first of them.
ScanCluster clusterOf(const Scene& scene, const std::vector<Index>& scans)
{
  ScanCluster cluster{scans, {}};
  for (const Index scan : scans)
    cluster.poses.push_back(scene.pose(scans[0], scan));
  return cluster;
}

// The second of three rooms whose doors open on different things, taken for the first one, and where it is.
class PartChecks : public testing::Test {
protected:
  static constexpr Index door_a = 1, room_b = 2, door_b = 3;

  PartChecks() : scene_(test::roomsInARow(true).scene), judge_(scene_.scans)
  {
    scene_.addPair(room_b, door_b, scene_.pose(room_b, door_b), 0.3);
  }

  template <typename Check>
  bool ask(const std::vector<Index>& others, bool in_place, const Check& check) const
  {
    const ScanCluster rest = clusterOf(scene_, others);
    ScanCluster part{{room_b}, {scene_.pose(others[0], room_b)}};
    if (!in_place)
      part.poses[0] = scene_.scanned.truth[others[0]].inverse() * Eigen::Translation3d(0, -test::row_pitch, 0) *
                      scene_.scanned.truth[room_b];
    const GraphInput input = scene_.input();
    const ClusterFitter fitter(input, judge_);
    return check(PartCheck(judge_, fitter),
                 ClusterPart{part, rest, judge_.judge(rest, part, Eigen::Isometry3d::Identity())});
  }

  Scene scene_;
  const FreeSpaceJudge judge_;
};

TEST_F(PartChecks, WhatACertainPairPlacesElsewhereInItsClusterIsContested)
{
  for (const bool in_place : {true, false}) {
    const bool contested = ask({door_a, door_b}, in_place, [](const PartCheck& check, const ClusterPart& placed) {
      return check.fitsElsewhere(placed);
    });
    EXPECT_EQ(contested, !in_place);
  }
}

// Of what free space contradicts where it is, the best pose of a pair that has others is enough.
TEST_F(PartChecks, WhatAnotherClusterIsSureOfIsClaimedByItUnlessThatMayBeThereToo)
{
  for (const bool certain : {true, false})
    for (const bool contradicted : {true, false})
      for (const bool in_place : {true, false}) {
        scene_.pairs[0].ambiguous = !certain;
        const bool claimed = ask({door_a}, in_place, [&](const PartCheck& check, ClusterPart placed) {
          placed.here.clustered = contradicted ? 0.1 : 0.0;
          return check.isClaimed(clusterOf(scene_, {door_b}), placed);
        });
        EXPECT_EQ(claimed, (certain || contradicted) && !in_place) << certain << contradicted << in_place;
      }
}

// Mixed pixels may do that. Nothing joins there.
TEST_F(PartChecks, ScansOfOneRoomThatHardlyContradictEachOtherMayClaim)
{
  scene_.pairs[0].hypotheses[0].check.overlap = 0.9;
  scene_.pairs[0].hypotheses[0].check.violation = 0.0017;
  scene_.addPair(door_a, door_b, scene_.pose(door_a, door_b), 0.6); // as pairs usually are
  const GraphInput input = scene_.input();
  const ClusterFitter fitter(input, judge_);
  const ScanCluster claimer = clusterOf(scene_, {door_b}), part = clusterOf(scene_, {room_b});
  EXPECT_TRUE(fitter.rough(claimer, part).empty());
  EXPECT_EQ(fitter.rough(claimer, part, ClusterFitter::Use::contest).size(), 1u);
  for (const bool in_place : {true, false}) {
    const bool claimed = ask({door_a}, in_place, [&](const PartCheck& check, const ClusterPart& placed) {
      return check.isClaimed(claimer, placed);
    });
    EXPECT_EQ(claimed, !in_place);
  }
}

TEST_F(PartChecks, WhatStandsInSpaceThatWasSeenThroughIsMisplaced)
{
  const auto misplaced = [&](const Eigen::Translation3d& shift) {
    const ScanCluster rest = clusterOf(scene_, {door_a, door_b});
    const ScanCluster part{{room_b}, {scene_.pose(door_a, room_b) * shift}};
    return PartCheck::isMisplaced({part, rest, judge_.judge(rest, part, Eigen::Isometry3d::Identity())});
  };
  EXPECT_FALSE(misplaced({0, 0, 0}));
  EXPECT_TRUE(misplaced({0.6, 0.6, 0}));
}

// Two scans that agree nearly everywhere tell their place in a building of equal rooms as little as one.
TEST_F(PartChecks, WhoAgreesNearlyEverywhereIsAloneInABuildingOfEqualRooms)
{
  constexpr Index room_a = 0, room_c = 4, door_c = 5;
  scene_.pairs.clear();
  scene_.addPair(room_b, door_b, scene_.pose(room_b, door_b), 0.95);
  const auto parted = [&](const ScanCluster& known) {
    std::vector<ScanCluster> clusters = {clusterOf(scene_, {door_a, room_b, door_b}), clusterOf(scene_, {room_a}),
                                         clusterOf(scene_, {room_c})};
    partEqualRooms(scene_.input(), known, clusters);
    return clusters;
  };
  EXPECT_EQ(parted({})[0].scans.size(), 3u); // nothing shows that rooms are equal
  for (const Index other : {room_a, room_c, door_c})
    scene_.addPair(room_b, other, Eigen::Isometry3d::Identity(), 0.95);
  const std::vector<ScanCluster> clusters = parted({});
  ASSERT_EQ(clusters.size(), 5u);
  EXPECT_EQ(clusters[0].scans, (std::vector<Index>{door_a}));
  EXPECT_EQ(clusters[3].refusal.reason, RefusalReason::repeats);
  EXPECT_EQ(parted(clusterOf(scene_, {door_a, room_b, door_b}))[0].scans.size(), 3u);
  scene_.pairs[0].hypotheses[0].check.overlap = 0.5;
  EXPECT_EQ(parted({})[0].scans.size(), 3u);
}

// The scans in the first and the third room see nothing of each other; those at their doors do.
TEST_F(PartChecks, WithoutTheScansBetweenWhatTheyHeldFallsApart)
{
  constexpr Index room_a = 0, room_c = 4, door_c = 5;
  const GraphInput input = scene_.input();
  const ClusterFitter fitter(input, judge_);
  const PartCheck check(judge_, fitter);
  const std::vector<ScanCluster> whole = check.heldTogether(clusterOf(scene_, {room_a, door_a, door_c, room_c}));
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(whole[0].scans, (std::vector<Index>{room_a, door_a, door_c, room_c}));
  const std::vector<ScanCluster> parts = check.heldTogether(clusterOf(scene_, {room_a, room_c}));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].scans, (std::vector<Index>{room_a}));
  EXPECT_EQ(parts[1].scans, (std::vector<Index>{room_c}));
}

constexpr Index seer = 0, last = 9;

// Ten scans of a room. Before the last one, a thing came into the view of the first one, which alone tells free space.
Scene changedRoom(double size)
{
  test::ScannedScene scanned;
  for (Index i = 0; i <= last; ++i) {
    test::Boxes boxes = test::twoRooms();
    if (i == last && size > 0.0)
      test::addBox(boxes, {2.2, 1.6, 0.0}, {2.2 + size, 1.6 + size, 1.2});
    scanned.truth.push_back(test::stationPose({1.0 + 0.3 * i, i % 2 ? 3.0 : 1.0, 1.5}, 0.4 * i, 0.0));
    scanned.scans.push_back(test::scanBoxes(boxes, scanned.truth.back(), 20000, 0.004, i + 1));
  }
  Scene scene(std::move(scanned));
  for (Index i = 1; i < last; ++i)
    scene.scans[i].free_space = {};
  for (Index i = 0; i < last; ++i)
    scene.addPair(i, i + 1, scene.pose(i, i + 1),
                  i == 7 ? 0.5 : 0.9); // so that two clusters are there before they join
  return scene;
}

TEST(ClusterJoins, OnePairThatContradictsALittleDoesNotKeepClustersApart)
{
  for (const double size : {0.0, 0.4, 1.0}) {
    const Scene scene = changedRoom(size);
    const double violation = pairViolation(scene.scans[seer], scene.scans[last], scene.pose(seer, last), check_level);
    EXPECT_EQ(violation > mostViolation(scene.pairs, scene.options.max_violation), size > 0.0) << violation;
    const std::size_t placed = buildScanGraph(scene.input(), {}).clusters.front().scans.size();
    EXPECT_EQ(placed, size < 0.5 ? 10u : 8u) << violation;
  }
}
} // namespace
} // namespace fresco::registration
