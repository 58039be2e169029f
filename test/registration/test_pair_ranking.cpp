// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_ranking.h"
#include "registration/registration_scene.h"
#include <gtest/gtest.h>
namespace fresco::registration {
namespace {
constexpr Index rooms = 3, scans_a_room = 3;

struct Described {
  std::vector<PreparedScan> scans;
  std::vector<ScanFeatures> features;
};

// Closed rooms of different sizes, each seen from three places; every scan turned arbitrarily in its own frame.
Described scanClosedRooms()
{
  Described all;
  for (Index room = 0; room < rooms; ++room) {
    const Eigen::Vector3d size(4.0 + 0.7 * room, 5.0 - 0.4 * room, 2.6);
    test::Boxes boxes;
    test::addRoom(boxes, {0, 0, 0}, size, std::nan(""));
    test::addFurniture(boxes, {0.3, 0.3, 0}, {size.x() - 0.3, size.y() - 0.3, 0}, 8, 7 + room);
    for (Index k = 0; k < scans_a_room; ++k) {
      const double at = 0.25 * (k + 1);
      const auto pose = test::stationPose({at * size.x(), (k == 1 ? 0.3 : 0.6) * size.y(), 1.5}, 1.7 * k, 0.02);
      const Eigen::AngleAxisd turn(0.8 + room + 2.1 * k, Eigen::Vector3d(1, k, room - 1.0).normalized());
      const PointSet scan = test::scanBoxes(boxes, pose, 15000, 0.004, static_cast<unsigned>(3 * room + k));
      Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
      T.topLeftCorner<3, 3>() = turn.toRotationMatrix();
      all.scans.push_back(prepareScan(transformPoints(scan, T), Thinning(0.04), 0));
      all.features.push_back(describeScan(all.scans.back(), {}));
    }
  }
  return all;
}

std::vector<RankedPair> ranked(const Described& all, int threads)
{
  std::vector<RankedPair> pairs;
  const Index n = all.scans.size();
  for (Index a = 0; a < n; ++a)
    for (Index b = a + 1; b < n; ++b)
      pairs.push_back({a, b, 0.0});
  RankingOptions options;
  options.by_place = true;
  options.threads = threads;
  rankPairs(pairs, all.scans, all.features, options);
  return pairs;
}

TEST(PairRanking, ScansOfOneRoomComeFirst)
{
  const std::vector<RankedPair> pairs = ranked(scanClosedRooms(), 0);
  for (Index k = 0; k < rooms * scans_a_room; ++k) // each room has three pairs
    EXPECT_EQ(pairs[k].a / scans_a_room, pairs[k].b / scans_a_room) << pairs[k].a << ' ' << pairs[k].b;
}

TEST(PairRanking, ThreadsDoNotChangeTheOrder)
{
  const Described all = scanClosedRooms();
  const std::vector<RankedPair> one = ranked(all, 1), four = ranked(all, 4);
  for (std::size_t k = 0; k < one.size(); ++k)
    EXPECT_EQ(std::tuple(one[k].a, one[k].b, one[k].likeness), std::tuple(four[k].a, four[k].b, four[k].likeness));
}

TEST(PairRanking, EveryScanHasPartnersInARound)
{
  std::vector<RankedPair> pairs = ranked(scanClosedRooms(), 0);
  const std::size_t all = pairs.size();
  std::vector<int> partners(rooms * scans_a_room, 0);
  const std::vector<RankedPair> round = takeRound(pairs, std::vector<char>(partners.size(), 0));
  for (const RankedPair& pair : round) {
    ++partners[pair.a];
    ++partners[pair.b];
  }
  EXPECT_GE(*std::min_element(partners.begin(), partners.end()), 4);
  EXPECT_EQ(round.size() + pairs.size(), all);
}
} // namespace
} // namespace fresco::registration
