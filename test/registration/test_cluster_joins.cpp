// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/part_exchange.h"
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

// In the frame of the first of them.
ScanCluster clusterOf(const Scene& scene, const std::vector<Index>& scans)
{
  ScanCluster cluster{scans, {}};
  for (const Index scan : scans)
    cluster.poses.push_back(scene.pose(scans[0], scan));
  return cluster;
}

// The part of a join that pairs also lead to another place of its cluster, an equal room, is undecided. What is seen
// through doors may tell the rooms apart.
TEST(PartExchange, AScanThatFitsInTwoEqualRoomsOfItsClusterIsTakenOut)
{
  constexpr Index door_a = 1, room_b = 2, door_b = 3;
  for (const bool telling : {false, true})
    for (const bool second_pair : {false, true})
      for (const bool known : {false, true}) {
        Scene scene(test::roomsInARow(telling).scene);
        scene.addPair(room_b, door_b, scene.pose(room_b, door_b), 0.6);
        const Eigen::Isometry3d in_a(Eigen::Translation3d(0, -test::row_pitch, 0) * scene.scanned.truth[room_b]);
        if (second_pair)
          scene.addPair(door_a, room_b, scene.scanned.truth[door_a].inverse() * in_a, 0.6);
        ScanGraph graph;
        graph.clusters = {clusterOf(scene, {door_a, door_b, room_b})};
        graph.parts = {{door_a}, {door_a, door_b}, {room_b}};
        partSecondPlaces(scene.input(), known ? clusterOf(scene, {room_b}) : ScanCluster(), graph);
        const bool taken = second_pair && !telling && !known;
        ASSERT_EQ(graph.clusters.size(), taken ? 2u : 1u) << telling << second_pair << known;
        EXPECT_EQ(graph.clusters.back().refusal.reason, taken ? RefusalReason::second_place : RefusalReason::none);
        EXPECT_EQ(graph.clusters.back().scans.back(), room_b);
      }
}

// Two scans that agree nearly everywhere tell their place in a building of equal rooms as little as one.
TEST(EqualRooms, WhoAgreesNearlyEverywhereIsAlone)
{
  constexpr Index room_a = 0, door_a = 1, room_b = 2, door_b = 3, room_c = 4, door_c = 5;
  Scene scene(test::roomsInARow(true).scene);
  scene.addPair(room_b, door_b, scene.pose(room_b, door_b), 0.95);
  const auto parted = [&](const ScanCluster& known) {
    std::vector<ScanCluster> clusters = {clusterOf(scene, {door_a, room_b, door_b}), clusterOf(scene, {room_a}),
                                         clusterOf(scene, {room_c})};
    partEqualRooms(scene.input(), known, clusters);
    return clusters;
  };
  EXPECT_EQ(parted({})[0].scans.size(), 3u); // nothing shows that rooms are equal
  for (const Index other : {room_a, room_c, door_c})
    scene.addPair(room_b, other, Eigen::Isometry3d::Identity(), 0.95);
  const std::vector<ScanCluster> clusters = parted({});
  ASSERT_EQ(clusters.size(), 5u);
  EXPECT_EQ(clusters[0].scans, (std::vector<Index>{door_a}));
  EXPECT_EQ(clusters[3].refusal.reason, RefusalReason::repeats);
  EXPECT_EQ(parted(clusterOf(scene, {door_a, room_b, door_b}))[0].scans.size(), 3u);
  scene.pairs[0].hypotheses[0].check.overlap = 0.5;
  EXPECT_EQ(parted({})[0].scans.size(), 3u);
}

// Stations of a survey keep apart. Where rooms have fallen into one, they do not. A place may be measured twice.
TEST(EqualRooms, StationsThatCrowdAreOfSeveralRooms)
{
  for (const double spacing : {0.0, 0.04, 0.1, 0.2, 0.3, 0.5}) { // median ranges
    Scene scene(test::roomsInARow(true).scene);
    ScanCluster row;
    for (Index k = 0; k < static_cast<Index>(scene.scans.size()); ++k) {
      row.scans.push_back(k);
      row.poses.emplace_back(Eigen::Translation3d(spacing * scene.scans[0].size * static_cast<double>(k), 0.0, 0.0));
      if (k > 0)
        scene.addPair(k - 1, k, row.poses[k - 1].inverse() * row.poses[k], 0.95);
    }
    std::vector<ScanCluster> clusters = {row};
    partEqualRooms(scene.input(), {}, clusters);
    EXPECT_EQ(clusters.size(), spacing > 0.05 && spacing < 0.25 ? scene.scans.size() : 1u) << spacing;
  }
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
