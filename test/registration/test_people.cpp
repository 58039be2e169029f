// SPDX-License-Identifier: BSD-3-Clause
#include "graph/free_space_evidence.h"
#include "graph/moved_people.h"
#include "registration/look_alike_scenes.h"
#include "scan/people.h"
#include <fresco/registration/core/scan_registration.h>
#include <gtest/gtest.h>
namespace fresco::registration {
namespace {
const test::Box standing{{3.2, 2.2, 0.85}, {0.2, 0.15, 0.85}, 0.4}, at_wall{{5.7, 2.5, 0.85}, {0.15, 0.15, 0.85}, 0.8};

// With what a person must not be taken for, each seen from the places below.
test::Boxes furnishedRoom(const test::Boxes& people)
{
  test::Boxes boxes;
  test::addRoom(boxes, {0, 0, 0}, {6, 5, 2.6}, std::numeric_limits<double>::quiet_NaN());
  test::addBox(boxes, {2, 4.6, 0}, {2.9, 5, 1.8});     // a cupboard
  test::addBox(boxes, {4, 1, 0}, {5.4, 1.8, 0.75});    // a table
  test::addBox(boxes, {4.6, 3.6, 0}, {5, 4, 0.5});     // low
  test::addBox(boxes, {0.8, 3.2, 0}, {1.1, 3.5, 2.6}); // a column
  boxes.insert(boxes.end(), people.begin(), people.end());
  return boxes;
}

PreparedScan scanOf(const test::Boxes& people, const Eigen::Isometry3d& T, unsigned seed)
{
  return prepareScan(test::scanBoxes(furnishedRoom(people), T, 30000, 0.004, seed), Thinning(0.04), 0);
}

std::vector<char> peopleIn(const PreparedScan& scan)
{
  const auto frame = findPlanFrame(scan, findPlanes(scan));
  return frame ? findPeople(scan, *frame) : std::vector<char>();
}

TEST(People, AreFoundAndNothingElse)
{
  const Eigen::Isometry3d T = test::stationPose({1, 1, 1.6}, 0.3, 0.01);
  for (const test::Boxes& people : {test::Boxes{}, {standing}, {at_wall}, {standing, at_wall}}) {
    const PreparedScan scan = scanOf(people, T, 1);
    const Points& points = scan.levels[check_level].points;
    const std::vector<char> found = peopleIn(scan);
    ASSERT_EQ(static_cast<Index>(found.size()), points.cols());
    Index of_people = 0, right = 0, wrong = 0;
    for (Index i = 0; i < points.cols(); ++i) {
      const Eigen::Vector3d p = T * (points.col(i).cast<double>() + scan.center);
      double distance = std::numeric_limits<double>::infinity();
      for (const test::Box& person : people)
        distance = std::min(distance, test::surfaceDistance(person, p));
      const bool is_person = distance < 0.05 && p.z() > 0.3;
      of_people += is_person ? 1 : 0;
      right += is_person && found[i] != 0 ? 1 : 0;
      wrong += distance > 0.5 && found[i] != 0 ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(of_people > 20, !people.empty());
    EXPECT_GE(right, 0.9 * of_people);
  }
}

// Who was there when one of two scans was made speaks against no pose, if people are left out; walls still do.
TEST(People, ContradictNothingWhereTheyAreLeftOut)
{
  const Eigen::Isometry3d T_a = test::stationPose({1, 1, 1.6}, 0.3, 0.01),
                          T_b = test::stationPose({5, 4.3, 1.6}, 2, 0.01);
  std::vector<PreparedScan> scans = {scanOf({}, T_a, 1), scanOf({standing}, T_b, 2)};
  const Eigen::Isometry3d T =
      (T_a * Eigen::Translation3d(scans[0].center)).inverse() * T_b * Eigen::Translation3d(scans[1].center);
  EXPECT_TRUE(isContradicted(FreeSpaceJudge(scans).judge(0, 1, T)));
  for (PreparedScan& scan : scans) {
    scan.levels[check_level].maybe_person = peopleIn(scan);
    scan.spares_doubtful = true;
  }
  const FreeSpaceJudge judge(scans);
  EXPECT_FALSE(isContradicted(judge.judge(0, 1, T)));
  EXPECT_TRUE(isContradicted(judge.judge(0, 1, Eigen::Translation3d(0.5, 0, 0) * T)));
}

std::vector<PreparedScan> scansFrom(const IsometryVector& stations, const std::vector<test::Boxes>& people)
{
  std::vector<PreparedScan> scans;
  for (std::size_t k = 0; k < stations.size(); ++k)
    scans.push_back(scanOf(people[k], stations[k], static_cast<unsigned>(k) + 1));
  return scans;
}

// All pairs at their true poses.
std::vector<PairAlignment> truePairs(const std::vector<PreparedScan>& scans, const IsometryVector& stations)
{
  const auto placed = [&](Index k) { return stations[k] * Eigen::Translation3d(scans[k].center); };
  std::vector<PairAlignment> pairs;
  for (Index a = 0; a < static_cast<Index>(scans.size()); ++a)
    for (Index b = a + 1; b < static_cast<Index>(scans.size()); ++b) {
      PairAlignment pair;
      pair.a = a;
      pair.b = b;
      pair.hypotheses.resize(1);
      pair.hypotheses[0].T_a_b = placed(a).inverse() * placed(b);
      pair.hypotheses[0].check = checkPair(scans[a], scans[b], pair.hypotheses[0].T_a_b, check_level);
      pairs.push_back(pair);
    }
  return pairs;
}

// Who stays where they are is furniture.
TEST(People, AreSeenToMoveOnlyIfTheyDo)
{
  const IsometryVector stations = {test::stationPose({1, 1, 1.6}, 0.3, 0.01), test::stationPose({5, 4.3, 1.6}, 2, 0.01),
                                   test::stationPose({1.6, 4, 1.6}, 1, 0.01)};
  const test::Box other{{3.4, 3.2, 0.85}, {0.2, 0.15, 0.85}, 0.4};
  const auto moved = [&](const std::vector<test::Boxes>& people) {
    std::vector<PreparedScan> scans = scansFrom(stations, people);
    PlanFrames frames = findPlanFrames(scans, 0);
    spareDoubtful(scans, frames, 0);
    const bool found = peopleMoved(scans, truePairs(scans, stations), 0);
    EXPECT_FALSE(scans[0].levels[check_level].maybe_person.empty());
    spareNothing(scans);
    EXPECT_TRUE(scans[0].levels[check_level].maybe_person.empty());
    EXPECT_FALSE(scans[0].spares_doubtful);
    return found;
  };
  EXPECT_FALSE(moved({{}, {}, {}}));
  EXPECT_FALSE(moved({{standing}, {standing}, {standing}}));
  EXPECT_TRUE(moved({{standing}, {other}, {}}));
}
} // namespace
} // namespace fresco::registration
