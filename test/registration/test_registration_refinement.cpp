// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/free_motion.h"
#include "refinement/placement.h"
#include "registration/look_alike_scenes.h"
#include "registration/registration_scene.h"
#include "registration_result.h"
#include <fresco/registration/core/point_to_plane_registration.h>
#include <fresco/registration/core/scan_registration.h>
#include <gtest/gtest.h>
namespace fresco {
namespace {
using test::disturbed;
using test::relativeError;
using test::ScannedScene;

const ScannedScene& scene()
{
  static const ScannedScene scanned = test::scanTwoRooms();
  return scanned;
}

ScanRegistrationOptions withThreads(int threads)
{
  ScanRegistrationOptions options;
  options.threads = threads;
  return options;
}

// Little holds a scan of a room and one in front of its door along the corridor. Coarse points, which stand for whole
// neighbourhoods, are not to move them.
TEST(ScanRefinement, RightPlacesDoNotSlide)
{
  for (const bool telling : {false, true})
    for (const Index rays : {6000, 15000, 30000}) {
      const ScannedScene row = test::roomsInARow(telling, rays).scene;
      const PointSet& first = row.scans[0];
      ScanRegistrationOptions options;
      options.voxel = static_cast<float>(registrationVoxel(first));
      options.max_distance = 20.f * options.voxel;
      const registration::Thinning thinning(options.voxel, registration::scanSize(first),
                                            registration::narrowness(first));
      std::vector<registration::PreparedScan> scans;
      registration::Placement placement;
      IsometryVector truth;
      for (const Index i : {0, 1}) {
        scans.push_back(registration::prepareScan(row.scans[i], thinning, 0));
        placement.members.push_back(i);
        truth.push_back(row.truth[i] * Eigen::Translation3d(scans.back().center));
      }
      placement.poses = truth;
      registration::refinePlacement(scans, options, placement, {});
      const Eigen::Isometry3d found = placement.poses[0].inverse() * placement.poses[1];
      EXPECT_LT((found.matrix() - (truth[0].inverse() * truth[1]).matrix()).norm(), 0.015) << rays;
    }
}

// Noise of 4 mm over thousands of matches leaves well below a millimetre; half a noise level is the bound.
TEST(ScanRefinement, DisturbedPosesAreRecovered)
{
  for (const auto& [offset, degrees] : {std::pair(0.05, 2.0), std::pair(0.3, 10.0)}) {
    const auto result = registerScans(scene().scans, disturbed(scene(), offset, degrees));
    const auto error = relativeError(result.poses, scene());
    EXPECT_LT(error.translation, 0.002) << offset;
    EXPECT_LT(error.degrees, 0.05) << offset;
    EXPECT_TRUE(result.converged);
    EXPECT_NEAR(result.rms, 0.004, 0.002);
    EXPECT_EQ(result.groups, 1);
  }
}

TEST(ScanRefinement, DeviationsTellTheErrors)
{
  const auto result = registerScans(scene().scans, disturbed(scene(), 0.05, 2.0));
  const auto error = relativeError(result.poses, scene());
  double largest = 0.0;
  for (const ScanResult& scan : result.scans)
    largest = std::max(largest, scan.translation_deviation);
  EXPECT_LT(error.translation, 10.0 * largest);
  EXPECT_LT(largest, 0.002);
}

TEST(ScanRefinement, FirstScanKeepsItsPoseAndAMovedStartMovesAll)
{
  const auto start = disturbed(scene(), 0.05, 2.0);
  Eigen::Isometry3d G = Eigen::Translation3d(10, -3, 2) * Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized());
  std::vector<Pose> moved;
  for (const Pose& pose : start)
    moved.push_back(Eigen::Matrix4d(G.matrix() * *pose));
  const auto here = registerScans(scene().scans, start), there = registerScans(scene().scans, moved);
  EXPECT_LT((*here.poses[0] - *start[0]).norm(), 1e-6);
  for (std::size_t i = 0; i < start.size(); ++i)
    EXPECT_LT((G.matrix() * *here.poses[i] - *there.poses[i]).norm(), 1e-3);
}

TEST(ScanRefinement, ThreadsDoNotChangeTheResult)
{
  const auto start = disturbed(scene(), 0.1, 3.0);
  const auto one = registerScans(scene().scans, start, withThreads(1)),
             four = registerScans(scene().scans, start, withThreads(4));
  for (std::size_t i = 0; i < start.size(); ++i)
    EXPECT_EQ(*one.poses[i], *four.poses[i]);
  EXPECT_EQ(one.rms, four.rms);
}

TEST(ScanRefinement, OrderOfScansDoesNotMatter)
{
  ScannedScene turned;
  const auto start = disturbed(scene(), 0.1, 3.0);
  std::vector<Pose> turned_start;
  for (std::size_t i = start.size(); i-- > 0;) {
    turned.scans.push_back(scene().scans[i]);
    turned.truth.push_back(scene().truth[i]);
    turned_start.push_back(start[i]);
  }
  const auto result = registerScans(turned.scans, turned_start);
  EXPECT_LT(relativeError(result.poses, turned).translation, 0.002);
}

TEST(ScanRefinement, NotANumberAndEmptyScansAreLeftOut)
{
  ScannedScene damaged = scene();
  for (Index i = 0; i < damaged.scans[0].size(); i += 10)
    damaged.scans[0].points(i % 3, i) = std::numeric_limits<float>::quiet_NaN();
  damaged.scans[4] = PointSet{};
  const auto result = registerScans(damaged.scans, disturbed(damaged, 0.05, 2.0));
  EXPECT_FALSE(result.poses[4].has_value());
  EXPECT_NE(result.scans[4].problem, "");
  EXPECT_EQ(result.scans[4].group, -1);
  EXPECT_LT(relativeError(result.poses, damaged).translation, 0.002);
}

TEST(ScanRefinement, SingleScanStays)
{
  const auto start = std::vector<Pose>{scene().truth[2].matrix()};
  const auto result = registerScans({scene().scans[2]}, start);
  ASSERT_TRUE(result.poses[0].has_value());
  EXPECT_LT((*result.poses[0] - *start[0]).norm(), 1e-9);
}

TEST(ScanRefinement, IdenticalScansCoincide)
{
  const auto result = registerScans({scene().scans[0], scene().scans[0]},
                                    {Eigen::Matrix4d(Eigen::Matrix4d::Identity()),
                                     (Eigen::Translation3d(0.1, 0, 0) * Eigen::Isometry3d::Identity()).matrix()});
  EXPECT_LT((*result.poses[1] - *result.poses[0]).norm(), 1e-3);
}

TEST(ScanRefinement, ContradictingStartPoseIsRefused)
{
  auto start = disturbed(scene(), 0.02, 1.0);
  // The second room's scan in the first room, turned: its walls stand where the others look through.
  *start[4] = test::stationPose({2.0, 2.0, 1.5}, 0.5, 0.0).matrix();
  const auto result = registerScans(scene().scans, start);
  EXPECT_FALSE(result.poses[4].has_value());
  EXPECT_NE(result.scans[4].problem.find("contradicts"), std::string::npos) << result.scans[4].problem;
  EXPECT_LT(relativeError(result.poses, scene()).translation, 0.002);
}

TEST(ScanRefinement, FreeDirectionOfAPlaneIsNamed)
{
  // Two scans of one wall: nothing holds them along it.
  test::Boxes wall;
  test::addBox(wall, {-20, 3, -20}, {20, 3.1, 20});
  const auto first = test::scanBoxes(wall, test::stationPose({0, 0, 0}, 0, 0), 20000, 0.002, 1);
  const auto second = test::scanBoxes(wall, test::stationPose({0.2, 0, 0}, 0, 0), 20000, 0.002, 2);
  const auto result = registerScans(
      {first, second}, {Eigen::Matrix4d(Eigen::Matrix4d::Identity()), test::stationPose({0.2, 0, 0}, 0, 0).matrix()});
  ASSERT_TRUE(result.scans[1].free_motion.has_value());
  const FreeMotion motion = *result.scans[1].free_motion;
  EXPECT_LT(std::abs(motion.translation.y()), 0.2);
  EXPECT_NEAR(motion.translation.norm() + motion.rotation.norm(), 1.0, 1e-6);
}

ScanRegistrationOptions withinOneNiche()
{
  ScanRegistrationOptions options;
  options.voxel = 0.02f;
  options.max_distance = 0.4f; // the next one is 3 m away
  return options;
}

// Scans that hold each other hide that nothing holds them both.
TEST(ScanRefinement, ScansThatSlideTogetherHaveAFreeMotion)
{
  const ScannedScene niches = test::scanNiches();
  const auto result = registerScans(niches.scans, disturbed(niches, 0.02, 0.5), withinOneNiche());
  EXPECT_FALSE(result.scans[0].free_motion || result.scans[1].free_motion);
  for (const Index i : {2, 3}) {
    ASSERT_EQ(result.scans[i].group, 0) << i;
    ASSERT_TRUE(result.scans[i].free_motion.has_value()) << i;
    EXPECT_GT(std::abs(result.scans[i].free_motion->translation.x()), 0.9) << i;
    EXPECT_GT(result.scans[i].translation_deviation, 0.1) << i;
    EXPECT_LT(result.scans[i].rotation_deviation, 0.01) << "only along the corridor";
  }
}

// What no surface holds, a start pose does as far as it can be off: it places a scan only if that is little.
TEST(ScanRefinement, WhatSlidesIsPlacedByAnExactStartPoseOnly)
{
  const ScannedScene niches = test::scanNiches();
  ScanRegistrationOptions options = withinOneNiche();
  const auto start = disturbed(niches, 0.005, 0.1);
  for (const bool exact : {false, true}) {
    options.max_distance = exact ? 0.02f : 0.4f;
    const auto result = registerScans(niches.scans, start, options);
    for (const Index i : {0, 1, 2, 3}) {
      EXPECT_EQ(result.scans[i].placed, exact || i < 2) << i;
      EXPECT_EQ(result.scans[i].refusal.reason, exact || i < 2 ? RefusalReason::none : RefusalReason::loose) << i;
    }
  }
}

// Other walls within the reach do not matter where the right ones are near.
TEST(ScanRefinement, NearStartPosesDoNotDependOnTheReach)
{
  const auto start = disturbed(scene(), 0.02, 0.5);
  ScanRegistrationOptions near, far;
  near.max_distance = 0.3f;
  far.max_distance = 2.f;
  const auto result = registerScans(scene().scans, start, far);
  EXPECT_LT(relativeError(result.poses, scene()).translation, 0.002);
  EXPECT_EQ(result.poses, registerScans(scene().scans, start, near).poses);
}

// Scans 0, 2 and 3 of the niches, of which those that stand alone slide.
registration::Placement refinedNiches(const ScanRegistrationOptions& options,
                                      std::vector<registration::PreparedScan>& scans)
{
  const ScannedScene niches = test::scanNiches();
  registration::Placement placement;
  for (const Index i : {0, 2, 3}) {
    scans.push_back(registration::prepareScan(niches.scans[i], registration::Thinning(options.voxel), 0));
    placement.members.push_back(placement.members.size());
    placement.poses.push_back(niches.truth[i]);
  }
  registration::refinePlacement(scans, options, placement, {});
  return placement;
}

// A free motion counts beside the placed group as within it.
TEST(ScanRefinement, FreeMotionsBesideThePlacedGroupAreTold)
{
  ScanRegistrationOptions options = withinOneNiche();
  std::vector<registration::PreparedScan> scans;
  const registration::Placement beside = refinedNiches(options, scans);
  scans.push_back(registration::prepareScan(scene().scans[0], registration::Thinning(options.voxel), 0));
  registration::Placement main;
  main.members = {3};
  main.poses = {scene().truth[0]};
  registration::refinePlacement(scans, options, main, {});
  const auto result = registration::describeRegistration({scans, {}, options, {main, beside}, {}, {}, {}});
  EXPECT_TRUE(result.scans[3].placed);
  ASSERT_TRUE(result.scans[0].free_motion);
  EXPECT_FALSE(result.scans[0].placed);
  EXPECT_EQ(result.scans[0].translation_deviation, options.max_distance);
  EXPECT_NE(result.scans[0].problem.find("motion free"), std::string::npos) << result.scans[0].problem;
}

// Without start poses, it is the smaller part that has no place.
TEST(ScanRefinement, TheLargerPartIsNotTheFreeOne)
{
  std::vector<registration::PreparedScan> scans;
  const registration::Placement placement = refinedNiches(withinOneNiche(), scans);
  EXPECT_TRUE(registration::findFreeMotion(placement.joint.information[0]));
  EXPECT_FALSE(registration::findFreeMotion(placement.joint.information[1]));
  EXPECT_FALSE(registration::findFreeMotion(placement.joint.information[2]));
}

TEST(ScanRefinement, WrongInputIsRefused)
{
  const auto& scans = scene().scans;
  EXPECT_THROW(registerScans({}), std::invalid_argument);
  EXPECT_THROW(registerScans(scans, std::vector<Pose>(2)), std::invalid_argument);
  for (const auto& spoil : std::vector<std::function<void(ScanRegistrationOptions&)>>{
           [](auto& o) { o.voxel = -1.f; }, [](auto& o) { o.max_distance = std::nanf(""); },
           [](auto& o) { o.min_overlap = 0.f; }, [](auto& o) { o.max_violation = 2.f; },
           [](auto& o) { o.max_iterations = 0; }, [](auto& o) { o.threads = -1; },
           [](auto& o) { o.names = {"one"}; }}) {
    ScanRegistrationOptions options;
    spoil(options);
    EXPECT_THROW(registerScans(scans, {}, options), std::invalid_argument);
  }
  std::vector<PointSet> mixed = {scans[0], scans[1]};
  mixed[1].points *= 1000.f;
  try {
    registerScans(mixed);
    FAIL() << "scans in metres and millimetres were accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("unit"), std::string::npos);
  }
}

TEST(ScanRefinement, CancellingStops)
{
  EXPECT_THROW(registerScans(scene().scans, {}, {}, [](std::string_view, double f) { return f < 0.3; }), Cancelled);
}

TEST(PointToPlane, PairIsAlignedFromFarOff)
{
  int good = 0, all = 0;
  for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2), std::pair(3, 4)}) {
    const Eigen::Isometry3d truth = scene().truth[a].inverse() * scene().truth[b];
    for (int k = 0; k < 5; ++k) {
      const double turn = 2.0 * M_PI * k / 5.0;
      const Eigen::Vector3d axis = Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.5).normalized();
      const Eigen::Isometry3d guess = truth *
                                      Eigen::Translation3d(0.3 * axis.cross(Eigen::Vector3d::UnitX()).normalized()) *
                                      Eigen::AngleAxisd(15.0 * M_PI / 180.0, axis);
      const auto result = alignPointToPlane(scene().scans[b], scene().scans[a], guess.matrix());
      good += (result.T_target_source - truth.matrix()).norm() < 0.02 && result.converged ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GE(good, all * 95 / 100) << "of " << all;
}

TEST(PointToPlane, WrongInputIsRefused)
{
  const auto& scans = scene().scans;
  const Eigen::Matrix4d I = Eigen::Matrix4d::Identity();
  EXPECT_THROW(alignPointToPlane(PointSet{}, scans[0], I), std::invalid_argument);
  EXPECT_THROW(alignPointToPlane(scans[0], scans[1], I * std::nan("")), std::invalid_argument);
  PointToPlaneOptions options;
  options.max_distance = -1.f;
  EXPECT_THROW(alignPointToPlane(scans[0], scans[1], I, options), std::invalid_argument);
  EXPECT_THROW(prepareForRegistration(scans[0], 0.f), std::invalid_argument);
}
} // namespace
} // namespace fresco
