// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/submap_joining.h"
#include "graph/free_space_evidence.h"
#include "registration/look_alike_scenes.h"
#include <fresco/registration/core/point_to_plane_registration.h>
#include <gtest/gtest.h>
namespace fresco::registration {
namespace {
// Scans of which no pair is known.
struct Scene {
  IsometryVector truth;
  std::vector<PreparedScan> scans;
  std::vector<PairAlignment> pairs;
  PlanFrames frames;
  GraphOptions options;

  explicit Scene(const test::ScannedScene& scanned)
  {
    const Thinning thinning(registrationVoxel(scanned.scans[0]));
    for (std::size_t k = 0; k < scanned.scans.size(); ++k) {
      scans.push_back(prepareScan(scanned.scans[k], thinning, 0));
      truth.push_back(scanned.truth[k] * Eigen::Translation3d(scans[k].center));
      frames.push_back(findPlanFrame(scans[k], findPlanes(scans[k])));
    }
    options.tolerance = 4.f * thinning.voxels[0];
  }
  GraphInput input() const { return {scans, pairs, options}; }

  // At their true poses; the frame is that of the first.
  ScanCluster cluster(const std::vector<Index>& members) const
  {
    ScanCluster made;
    for (const Index scan : members) {
      made.scans.push_back(scan);
      made.poses.push_back(truth[members[0]].inverse() * truth[scan]);
    }
    return made;
  }
  std::vector<ScanCluster> joined(const std::vector<std::vector<Index>>& clusters) const
  {
    ScanGraph graph;
    for (const std::vector<Index>& members : clusters)
      graph.clusters.push_back(cluster(members));
    joinSubmaps(input(), frames, graph, {});
    return graph.clusters;
  }
  double worstError(const ScanCluster& found) const
  {
    double worst = 0.0;
    for (std::size_t k = 1; k < found.scans.size(); ++k)
      worst = std::max(worst, poseDistance(found.poses[0].inverse() * found.poses[k],
                                           truth[found.scans[0]].inverse() * truth[found.scans[k]], scans[0].size));
    return worst;
  }
};

TEST(Submaps, JoinWhereNoPairTells)
{
  const Scene scene(test::scanTwoRooms());
  const std::vector<ScanCluster> clusters = scene.joined({{0, 1, 2}, {3, 4}});
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].scans.size(), 5u);
  EXPECT_LT(scene.worstError(clusters[0]), 0.03);
}

// A pair alone would not join them: it overlaps little, and something contradicts it.
TEST(Submaps, JoinWhereAPairIsUnsure)
{
  Scene scene(test::scanTwoRooms());
  std::fill(scene.frames.begin(), scene.frames.end(), std::nullopt);
  const std::vector<std::vector<Index>> groups{{0, 1, 2}, {3, 4}};
  EXPECT_EQ(scene.joined(groups).size(), 2u);
  VerifiedHypothesis unsure;
  unsure.T_a_b = scene.truth[2].inverse() * scene.truth[3];
  unsure.check.overlap = 0.1;
  unsure.check.violation = 0.005;
  PairAlignment pair;
  pair.a = 2;
  pair.b = 3;
  pair.hypotheses = {unsure};
  scene.pairs = {pair};
  const std::vector<ScanCluster> clusters = scene.joined(groups);
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_LT(scene.worstError(clusters[0]), 0.03);
}

TEST(Submaps, DoNotDependOnThreads)
{
  Scene scene(test::scanTwoRooms());
  scene.options.threads = 1;
  const std::vector<ScanCluster> one = scene.joined({{0, 1, 2}, {3}, {4}});
  scene.options.threads = 3;
  const std::vector<ScanCluster> three = scene.joined({{0, 1, 2}, {3}, {4}});
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t c = 0; c < one.size(); ++c) {
    ASSERT_EQ(one[c].scans, three[c].scans);
    for (std::size_t k = 0; k < one[c].poses.size(); ++k)
      EXPECT_EQ(one[c].poses[k].matrix(), three[c].poses[k].matrix());
  }
}

// A scan of one of three equal rooms has a place in each, unless it saw what stands opposite to its own door.
TEST(Submaps, OfEqualRoomsJoinOnlyWhatTellsItsPlace)
{
  constexpr Index room_b = 2;
  for (const bool telling : {false, true}) {
    const Scene scene(test::roomsInARow(telling).scene);
    const std::vector<ScanCluster> clusters = scene.joined({{1, 3, 5}, {room_b}});
    ASSERT_EQ(clusters.size(), telling ? 1u : 2u);
    EXPECT_LT(scene.worstError(clusters[0]), 0.03);
  }
}

// A scan of one of two equal rooms fits in the other one. It is not placed there once another group has a place for it,
// too, and both cannot be right.
TEST(Submaps, ThirdGroupsKeepApartWhatFitsInThem)
{
  constexpr Index room_a = 0, door_a = 1, room_b = 2, door_b = 3, door_c = 5;
  const Scene scene(test::roomsInARow(false).scene);
  for (const bool third : {false, true}) {
    std::vector<std::vector<Index>> groups{{room_a, door_a}, {room_b}};
    if (third)
      groups.push_back({door_b, door_c});
    const std::vector<ClusterPlace> places = placesOf(scene.joined(groups), scene.scans.size());
    EXPECT_EQ(places[room_a].cluster == places[room_b].cluster, !third);
  }
}

TEST(FreeSpaceEvidence, EachPointIsConfirmedOnce)
{
  const Scene scene(test::scanTwoRooms());
  const FreeSpaceJudge judge(scene.scans);
  const ScanCluster first = scene.cluster({0, 1}), second = scene.cluster({2, 3});
  const Eigen::Isometry3d T = scene.truth[0].inverse() * scene.truth[2];
  const double confirmed = judge.judge(first, second, T).confirmed;
  EXPECT_DOUBLE_EQ(confirmed, judge.judge(second, first, T.inverse()).confirmed);
  EXPECT_LE(confirmed, judge.judge(first, second, T).agree);
  // Seen by one more scan from the same place, no other point of the second cluster is confirmed.
  ScanCluster twice = first;
  twice.scans.push_back(first.scans[0]);
  twice.poses.push_back(first.poses[0]);
  const ScanCluster again{{first.scans[0]}, {first.poses[0]}};
  const double seen_of_it = judge.judge(twice, second, T).confirmed - confirmed;
  EXPECT_GT(seen_of_it, 0.0);
  EXPECT_LT(seen_of_it, judge.judge(again, second, T).confirmed);
}
} // namespace
} // namespace fresco::registration
