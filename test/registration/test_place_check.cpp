// SPDX-License-Identifier: BSD-3-Clause
#include "graph/place_check.h"
#include "registration/look_alike_scenes.h"
#include <fresco/registration/core/point_to_plane_registration.h>
#include <gtest/gtest.h>
namespace fresco::registration {
namespace {
constexpr Index room_a = 0, door_a = 1, room_b = 2, door_b = 3; // scans of two of the equal rooms and of the corridor

// Prepared scans, and their pairs at the true poses. For the scan of room b there is also the pose in room a.
struct Row {
  test::ScannedScene scene;
  std::vector<PreparedScan> scans;
  std::vector<PairAlignment> pairs;
  Eigen::Isometry3d T_wrong; // working frame from scan of room b, as if in room a
  GraphOptions options;
};

void addHypothesis(const Row& row, const Eigen::Isometry3d& T_a_b, PairAlignment& pair)
{
  VerifiedHypothesis hypothesis;
  hypothesis.T_a_b = T_a_b;
  hypothesis.check = checkPair(row.scans[pair.a], row.scans[pair.b], T_a_b, check_level);
  hypothesis.support = hypothesis.check.overlap;
  hypothesis.score = alignmentScore(hypothesis.check);
  pair.hypotheses.push_back(hypothesis);
}

Row equalRooms(bool telling)
{
  Row row;
  row.scene = test::roomsInARow(telling).scene;
  const PointSet& first = row.scene.scans.front();
  const Thinning thinning(registrationVoxel(first), scanSize(first), narrowness(first));
  for (Index i = 0; i <= door_b; ++i)
    row.scans.push_back(prepareScan(row.scene.scans[i], thinning, 0));
  row.options.tolerance = 4.f * thinning.voxels[0];
  const auto& truth = row.scene.truth;
  row.T_wrong = Eigen::Translation3d(0, -test::row_pitch, 0) * truth[room_b];
  for (const auto& [a, b] : {std::pair(room_a, door_a), std::pair(door_a, door_b), std::pair(room_b, door_b)}) {
    row.pairs.push_back({a, b, {}, false, {}});
    addHypothesis(row, truth[a].inverse() * truth[b], row.pairs.back());
  }
  row.pairs.push_back({room_a, room_b, {}, false, {}});
  addHypothesis(row, truth[room_a].inverse() * row.T_wrong, row.pairs.back());
  return row;
}

ScanCluster clusterOf(const Row& row, const std::vector<Index>& scans)
{
  ScanCluster cluster;
  for (const Index scan : scans) {
    cluster.scans.push_back(scan);
    cluster.poses.push_back(row.scene.truth[scan]);
  }
  return cluster;
}

bool isSetAside(const Row& row, const ScanCluster& cluster, Index scan)
{
  const std::vector<Index> contested = contestedScans({row.scans, row.pairs, row.options}, {}, cluster);
  return std::find(contested.begin(), contested.end(), scan) != contested.end();
}

// Whether the scan fits in the other room by all that scans see of each other decides, not how well it fits.
TEST(PlaceCheck, ScansThatFitInTwoRoomsAreContestedInEither)
{
  for (const bool telling : {false, true}) {
    const Row row = equalRooms(telling);
    const ScanCluster right = clusterOf(row, {room_a, door_a, room_b, door_b});
    ScanCluster wrong = right;
    wrong.poses[2] = row.T_wrong;
    EXPECT_EQ(isSetAside(row, right, room_b), !telling);
    EXPECT_TRUE(isSetAside(row, wrong, room_b));
  }
}

TEST(PlaceCheck, KnownScansAreNotAsked)
{
  const Row row = equalRooms(false);
  const ScanCluster all = clusterOf(row, {room_a, door_a, room_b, door_b});
  EXPECT_TRUE(contestedScans({row.scans, row.pairs, row.options}, all, all).empty());
}

TEST(PlaceCheck, OneUncontestedPlaceIsTheTrueOne)
{
  for (const bool telling : {false, true}) {
    const Row row = equalRooms(telling);
    const ScanCluster moving = {{room_b}, {Eigen::Isometry3d::Identity()}};
    const ClusterPoses places =
        findPlaces({row.scans, row.pairs, row.options}, clusterOf(row, {room_a, door_a, door_b}), moving);
    const ClusterPose* place = uncontested(places, 0.1, 0.01);
    ASSERT_EQ(place != nullptr, telling);
    if (place != nullptr) {
      EXPECT_LT((place->T.translation() - row.scene.truth[room_b].translation()).norm(), 0.02);
    }
  }
}

ClusterPose placeAt(double x, double violation, double overlap)
{
  ClusterPose place;
  place.T = Eigen::Translation3d(x, 0, 0);
  place.violation = violation;
  place.overlap = overlap;
  return place;
}

TEST(PlaceCheck, OverlapDoesNotDecideBetweenPlacesButViolationsDo)
{
  const ClusterPoses equal = {placeAt(0, 0.0, 0.9), placeAt(5, 0.0, 0.5)};
  EXPECT_EQ(uncontested(equal, 0.25, 0.002), nullptr);
  const ClusterPoses contradicted = {placeAt(0, 0.02, 0.9), placeAt(5, 0.0, 0.5)};
  EXPECT_EQ(uncontested(contradicted, 0.25, 0.002), &contradicted[1]);
  const ClusterPoses chance = {placeAt(0, 0.0, 0.9), placeAt(5, 0.0, 0.2)};
  EXPECT_EQ(uncontested(chance, 0.25, 0.002), &chance[0]);
}

TEST(PlaceCheck, DoubtfulPlacesAreNotTaken)
{
  ClusterPoses places = {placeAt(0, 0.0, 0.9)};
  EXPECT_EQ(uncontested(places, 0.25, 0.002), &places[0]);
  places[0].doubtful = true;
  EXPECT_EQ(uncontested(places, 0.25, 0.002), nullptr);
}
} // namespace
} // namespace fresco::registration
