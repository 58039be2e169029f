// SPDX-License-Identifier: BSD-3-Clause
#include "evidence/arrangement.h"
#include "registration/registration_scene.h"
#include <fresco/registration/core/sc2_pcr.h>
#include <gtest/gtest.h>
namespace fresco::registration {
namespace {
/// Two furnished rooms that share a door, with places that are right and places that are not.
class Evidence : public ::testing::Test {
protected:
  static void SetUpTestSuite()
  {
    const test::ScannedScene scene = test::scanTwoRooms(12000);
    for (std::size_t i = 0; i < scene.scans.size(); ++i) {
      scans_.push_back(prepareScan(scene.scans[i], Thinning(0.03), 1));
      prepareManySearches(scans_.back());
      frame_.scans.push_back(i);
      frame_.poses.push_back(scene.truth[i] * Eigen::Translation3d(scans_.back().center));
    }
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2), std::pair(1, 3), std::pair(3, 4)}) {
      const Eigen::Isometry3d T = frame_.poses[a].inverse() * frame_.poses[b];
      places_.push_back({a, b, T});
      places_.push_back({a, b, T * Eigen::Translation3d(0.9, 0.4, 0)});
    }
  }
  static void TearDownTestSuite()
  {
    scans_.clear();
    places_.clear();
    frame_ = {};
  }
  // Ten proposals tell nothing of whether a building repeats its rooms: so a bound that does not depend on them.
  static EvidenceModel plainModel()
  {
    EvidenceModel model = fittedModel();
    model.room_base = 6.0;
    model.room_slope = 0.0;
    return model;
  }
  static FrameJudge judgeOn(int threads) { return {scans_, places_, model_, threads}; }
  static ScanCluster some(const std::vector<Index>& listed)
  {
    ScanCluster some;
    for (const Index i : listed) {
      some.scans.push_back(frame_.scans[i]);
      some.poses.push_back(frame_.poses[i]);
    }
    return some;
  }
  static const EvidenceModel model_;
  static std::vector<PreparedScan> scans_;
  static ProposedPlaces places_;
  static ScanCluster frame_; ///< the truth
};
const EvidenceModel Evidence::model_ = Evidence::plainModel();
std::vector<PreparedScan> Evidence::scans_;
ProposedPlaces Evidence::places_;
ScanCluster Evidence::frame_;

double confirmed(const ScanEvidence& evidence)
{
  double sum = 0.0;
  for (const RoomAgreement& room : evidence.rooms)
    for (const double count : room.confirmed)
      sum += count;
  return sum;
}

TEST_F(Evidence, PatchesBehindADoorAreOfAnotherRoom)
{
  const ScanPatches patches = makePatches(scans_[1]);
  Index behind = 0, told = 0, here = 0, mistaken = 0;
  for (Index i = 0; i < patches.size(); ++i) {
    const double x = (frame_.poses[1] * patches.points.col(i).cast<double>()).x();
    behind += x > 5.3 ? 1 : 0; // the wall with the door stands at 5 m
    told += x > 5.3 && patches.rooms[i] != 0 ? 1 : 0;
    here += x < 4.9 ? 1 : 0;
    mistaken += x < 4.9 && patches.rooms[i] != 0 ? 1 : 0;
  }
  EXPECT_GT(behind, 20);
  EXPECT_GT(told, 0.8 * behind);
  EXPECT_LT(mistaken, 0.05 * here);
}

TEST_F(Evidence, RightPlacesAreConfirmedAndWrongOnesContradicted)
{
  FrameJudge judge = judgeOn(2);
  for (std::size_t k = 0; k < places_.size(); k += 2) {
    EXPECT_GT(judge.logOdds(frameOf(places_[k])), judge.logOdds(frameOf(places_[k + 1])) + 5.0) << k;
    EXPECT_GT(confirmed(judge.evidenceOf(frameOf(places_[k]), 0)), 20.0) << k;
  }
}

TEST_F(Evidence, DependsNeitherOnTheOrderOfScansNorOnTheFrame)
{
  FrameJudge judge = judgeOn(2), other = judgeOn(2);
  ScanCluster moved = some({4, 2, 0, 3, 1});
  const Eigen::Isometry3d T =
      Eigen::Translation3d(3, -7, 0.5) * Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 2).normalized());
  for (Eigen::Isometry3d& pose : moved.poses)
    pose = T * pose;
  EXPECT_NEAR(judge.logOdds(some({0, 1, 2, 3, 4})), other.logOdds(moved), 0.05); // poses are rounded
}

TEST_F(Evidence, EachPatchVotesOnceHoweverManyScansSeeIt)
{
  const ScanPatches patches = makePatches(scans_[0]);
  const PatchVotes votes = votesOf(scans_[1], patches, frame_.poses[1].inverse() * frame_.poses[0]);
  const ScanEvidence once = judge(patches, {&votes}), thrice = judge(patches, {&votes, &votes, &votes});
  EXPECT_EQ(confirmed(once), confirmed(thrice));
  EXPECT_EQ(once.contradicted, thrice.contradicted);
}

TEST_F(Evidence, ADuplicateOfAScanMakesThePlaceOfAnotherNoLikelier)
{
  const std::vector<PreparedScan> scans{scans_[0], scans_[1], scans_[1]};
  FrameJudge judge(scans, {}, model_, 2); // the places are of other scans
  const Eigen::Isometry3d &a = frame_.poses[0], &b = frame_.poses[1];
  const double alone = judge.logOdds({{0, 1}, {a, b}});
  const double doubled = judge.logOdds({{0, 1, 2}, {a, b, b}}) - judge.logOdds({{1, 2}, {b, b}});
  EXPECT_LT(doubled, alone + 0.1);
}

TEST_F(Evidence, ManyPatchesOfOneRoomAreWorthNoMoreThanItsBound)
{
  ScanEvidence evidence;
  evidence.rooms.resize(1);
  evidence.rooms[0].confirmed = {1e6, 1e6, 1e6};
  evidence.rooms[0].witnesses = 1.0;
  const double most = 3.0;
  EXPECT_NEAR(fittedModel().logOdds({evidence, evidence}, most) - fittedModel().prior, most, 1e-9);
}

TEST_F(Evidence, RoomsThatAgreeWithoutBeingRefutedLowerTheBound)
{
  ScanEvidence clean, refuted;
  clean.rooms.resize(1);
  clean.rooms[0].confirmed = {2000, 1000, 1000};
  refuted = clean;
  refuted.contradicted[4] = 3;
  const std::array<ScanEvidence, 2> agreeing{clean, clean}, contradicted{clean, refuted};
  const EvidenceModel& model = fittedModel();
  EXPECT_GT(model.roomBound({agreeing, contradicted, contradicted, contradicted, contradicted}),
            model.roomBound({agreeing, agreeing, agreeing, contradicted, contradicted}));
}

TEST_F(Evidence, SearchFindsTheTruthOnAnyNumberOfThreads)
{
  SearchOptions options;
  options.tolerance = 0.12;
  FrameJudge one = judgeOn(1), four = judgeOn(4);
  const Arrangement found = findArrangement(one, places_, options), again = findArrangement(four, places_, options);
  ASSERT_EQ(found.frames.size(), again.frames.size());
  for (std::size_t f = 0; f < found.frames.size(); ++f) {
    EXPECT_EQ(found.frames[f].scans, again.frames[f].scans);
    for (std::size_t k = 0; k < found.frames[f].scans.size(); ++k) {
      EXPECT_EQ(found.frames[f].poses[k].matrix(), again.frames[f].poses[k].matrix());
      const Index first = found.frames[f].scans[0], scan = found.frames[f].scans[k];
      const Eigen::Isometry3d T = found.frames[f].poses[0].inverse() * found.frames[f].poses[k];
      EXPECT_LT(poseDistance(T, frame_.poses[first].inverse() * frame_.poses[scan], 3.0), 0.05);
    }
  }
  EXPECT_GE(found.frames[0].scans.size(), 3u);
  EXPECT_EQ(found.log_odds, again.log_odds);
}

TEST_F(Evidence, MoreCertaintyNeverMakesFramesLarger)
{
  SearchOptions options;
  options.tolerance = 0.12;
  FrameJudge judge = judgeOn(2);
  const Arrangement best = findArrangement(judge, places_, options);
  std::size_t before = best.frames[0].scans.size();
  for (const double least : {0.0, 2.0, 5.0, 50.0}) {
    const Arrangement certain = keepCertain(judge, places_, options, best, least);
    EXPECT_LE(certain.frames[0].scans.size(), before);
    before = certain.frames[0].scans.size();
    std::size_t scans = 0;
    for (const ScanCluster& frame : certain.frames)
      scans += frame.scans.size();
    EXPECT_EQ(scans, scans_.size());
  }
  EXPECT_EQ(before, 1u);
}
} // namespace
} // namespace fresco::registration
