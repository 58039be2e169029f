// SPDX-License-Identifier: BSD-3-Clause
#include "registration/registration_scene.h"
#include "test_data.h"
#include <fresco/io/point_io.h>
#include <fresco/registration/core/scan_registration.h>
namespace fresco {
namespace {
using test::relativeError;
using test::ScannedScene;

std::size_t placedCount(const ScanRegistrationResult& result)
{
  return static_cast<std::size_t>(
      std::count_if(result.poses.begin(), result.poses.end(), [](const Pose& p) { return p.has_value(); }));
}

/// Every scan turned arbitrarily in its own frame.
ScannedScene turned(ScannedScene scene)
{
  for (std::size_t i = 0; i < scene.scans.size(); ++i) {
    const double angle = 0.9 + 0.5 * static_cast<double>(i);
    const Eigen::Isometry3d T(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, static_cast<double>(i), -2).normalized()));
    scene.scans[i] = transformPoints(scene.scans[i], T.matrix());
    scene.truth[i] = scene.truth[i] * T.inverse();
  }
  return scene;
}

TEST(GlobalRegistration, ScansWithoutPosesArePlaced)
{
  const ScannedScene upright = test::scanTwoRooms(40000);
  for (const ScannedScene& scene : {upright, turned(upright)}) {
    const auto result = registerScans(scene.scans);
    EXPECT_EQ(placedCount(result), scene.scans.size());
    const auto error = relativeError(result.poses, scene);
    EXPECT_LT(error.translation, 0.005);
    EXPECT_LT(error.degrees, 0.1);
    EXPECT_LT((*result.poses[0] - Eigen::Matrix4d::Identity()).norm(), 1e-6);
  }
}

TEST(GlobalRegistration, ThreadsDoNotChangeTheResult)
{
  const ScannedScene scene = test::scanTwoRooms(30000);
  ScanRegistrationOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const auto a = registerScans(scene.scans, {}, one), b = registerScans(scene.scans, {}, four);
  EXPECT_EQ(a.poses, b.poses);
}

TEST(GlobalRegistration, ScansWithStartPosesHoldTheFrameOfTheOthers)
{
  const ScannedScene scene = test::scanTwoRooms(40000);
  std::vector<Pose> start(scene.scans.size());
  start[1] = scene.truth[1].matrix();
  start[3] = scene.truth[3].matrix();
  const auto result = registerScans(scene.scans, start);
  EXPECT_EQ(placedCount(result), scene.scans.size());
  EXPECT_LT((*result.poses[1] - *start[1]).norm(), 1e-6);
  EXPECT_LT(relativeError(result.poses, scene).translation, 0.005);
}

TEST(GlobalRegistration, ScansWithoutOverlapMakeTwoGroups)
{
  const ScannedScene scene = test::scanTwoRooms(30000);
  test::Boxes elsewhere;
  test::addRoom(elsewhere, {0, 0, 0}, {7, 3, 3.2}, std::numeric_limits<double>::quiet_NaN());
  test::addFurniture(elsewhere, {0.5, 0.5, 0}, {6.5, 2.5, 0}, 6, 21);
  std::vector<PointSet> scans = {scene.scans[0], scene.scans[1], scene.scans[2]};
  scans.push_back(test::scanBoxes(elsewhere, test::stationPose({2, 1.5, 1.5}, 0.4, 0), 30000, 0.004, 9));
  const auto result = registerScans(scans);
  EXPECT_EQ(placedCount(result), 3u);
  EXPECT_FALSE(result.poses[3].has_value());
  EXPECT_EQ(result.groups, 2);
  EXPECT_EQ(result.scans[3].group, 1);
  EXPECT_NE(result.scans[3].problem, "");
}

// The empty room looks the same from both ends: nothing can tell how the scans lie to each other.
TEST(GlobalRegistration, AmbiguousPairIsNotForced)
{
  test::Boxes room;
  test::addRoom(room, {0, 0, 0}, {5, 3, 2.6}, std::numeric_limits<double>::quiet_NaN());
  std::vector<PointSet> scans = {test::scanBoxes(room, test::stationPose({1, 1, 1.5}, 0.2, 0), 20000, 0.004, 1),
                                 test::scanBoxes(room, test::stationPose({3.2, 2, 1.5}, 1.2, 0), 20000, 0.004, 2)};
  const auto result = registerScans(scans);
  EXPECT_EQ(placedCount(result), 1u);
}

// A pair that is held together must lie right, in whatever group.
void expectNoFalsePair(const ScanRegistrationResult& result, const ScannedScene& scene)
{
  for (const PairResult& pair : result.pairs) {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    const Eigen::Isometry3d found(result.scans[a].T_group_scan.inverse() * result.scans[b].T_group_scan),
        truth = scene.truth[a].inverse() * scene.truth[b];
    if (pair.accepted && result.scans[a].group == result.scans[b].group) {
      EXPECT_LT((found.matrix() - truth.matrix()).norm(), 0.02) << a << " and " << b;
    }
  }
}

// What is seen through the doors outweighs that the rooms look alike.
TEST(GlobalRegistration, TwinRoomsAreToldApartByWhatTheDoorsShow)
{
  const ScannedScene scene = test::scanTwinRooms(true);
  const auto result = registerScans(scene.scans);
  expectNoFalsePair(result, scene);
  EXPECT_EQ(placedCount(result), scene.scans.size());
  EXPECT_LT(relativeError(result.poses, scene).translation, 0.01);
}

TEST(GlobalRegistration, TwinRoomsThatNothingTellsApartAreNotMerged)
{
  const ScannedScene scene = test::scanTwinRooms(false);
  const auto result = registerScans(scene.scans);
  expectNoFalsePair(result, scene);
  EXPECT_LT(placedCount(result), scene.scans.size());
}

TEST(GlobalRegistration, FewPointsAreNotPlaced)
{
  ScannedScene scene = test::scanTwoRooms(20000);
  scene.scans[1] = selectPoints(scene.scans[1], {0, 10, 20, 30, 40});
  const auto result = registerScans({scene.scans[0], scene.scans[1]});
  EXPECT_TRUE(result.poses[0].has_value());
  EXPECT_FALSE(result.poses[1].has_value());
}

// The flipped room fits as well; that scanners stand upright rules it out.
TEST(GlobalRegistration, UprightHintRulesOutPoses)
{
  const ScannedScene scene = test::scanTwoRooms(30000);
  ScanRegistrationOptions options;
  options.upright = true;
  const auto result = registerScans(scene.scans, {}, options);
  EXPECT_EQ(placedCount(result), scene.scans.size());
  EXPECT_LT(relativeError(result.poses, scene).translation, 0.005);
  for (const Pose& pose : result.poses)
    EXPECT_GT((*pose)(2, 2), 0.93);
}

TEST(GlobalRegistration, OtherUnitsAreNamed)
{
  ScannedScene scene = test::scanTwoRooms(5000);
  scene.scans[2].points *= 1000.f;
  ScanRegistrationOptions options;
  options.names = {"a.pcd", "b.pcd", "c.pcd", "d.pcd", "e.pcd"};
  try {
    registerScans(scene.scans, {}, options);
    FAIL() << "millimetres among metres were taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("c.pcd"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("unit"), std::string::npos) << error.what();
  }
}

TEST(GlobalRegistration, IdenticalScansCoincide)
{
  const ScannedScene scene = test::scanTwoRooms(20000);
  const auto result = registerScans({scene.scans[0], scene.scans[0], scene.scans[0]});
  ASSERT_EQ(placedCount(result), 3u);
  for (const Pose& pose : result.poses)
    EXPECT_LT((*pose - Eigen::Matrix4d::Identity()).norm(), 1e-3);
}

TEST(GlobalRegistration, NotANumberIsLeftOut)
{
  ScannedScene scene = test::scanTwoRooms(30000);
  for (Index i = 0; i < scene.scans[1].size(); i += 3)
    scene.scans[1].points(i % 3, i) = std::numeric_limits<float>::quiet_NaN();
  const auto result = registerScans({scene.scans[0], scene.scans[1]});
  EXPECT_EQ(placedCount(result), 2u);
  EXPECT_LT(relativeError(result.poses, scene).translation, 0.005);
}

// One wall says nothing of the motions along it: either the pair is left alone, or the free motion is named.
TEST(GlobalRegistration, WallsAreNotForcedTogether)
{
  test::Boxes wall;
  test::addBox(wall, {-20, 3, -20}, {20, 3.1, 20});
  const auto result = registerScans({test::scanBoxes(wall, test::stationPose({0, 0, 0}, 0, 0), 20000, 0.002, 1),
                                     test::scanBoxes(wall, test::stationPose({1.2, 0, 0}, 0.7, 0), 20000, 0.002, 2)});
  EXPECT_TRUE(!result.poses[1] || result.scans[1].free_motion);
}

TEST(GlobalRegistration, ScansAreReadOneAfterTheOther)
{
  const ScannedScene scene = test::scanTwoRooms(20000);
  const ScanSource source{2, [&](Index i) { return scene.scans[i]; }};
  EXPECT_EQ(registerScans(source).poses, registerScans({scene.scans[0], scene.scans[1]}).poses);
}

TEST(GlobalRegistration, RealLaserScans)
{
  FRESCO_NEED_DATA("lobby/room_scan1.pcd");
  const std::string folder = test::dataFolder() + "/lobby/room_scan";
  const auto result = registerScans({readPoints(folder + "1.pcd"), readPoints(folder + "2.pcd")});
  EXPECT_EQ(placedCount(result), 2u);
  ASSERT_EQ(result.pairs.size(), 1u);
  EXPECT_GT(result.pairs[0].overlap, 0.5);
  EXPECT_LT(result.rms, 0.04); // the scanner's noise is centimetres
}

TEST(MergeScans, KeepsAttributesAndTurnsNormalsToViewpoints)
{
  ScannedScene scene = test::scanTwoRooms(4000);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < scene.scans.size(); ++i) {
    scene.scans[i].colors = Colors::Constant(3, scene.scans[i].size(), static_cast<std::uint8_t>(10 * i));
    scene.scans[i].intensities = Eigen::VectorXf::Constant(scene.scans[i].size(), static_cast<float>(i));
    poses.push_back(scene.truth[i].matrix());
  }
  scene.scans[0].points.col(7).setConstant(std::numeric_limits<float>::quiet_NaN());
  poses[3].reset();
  const PointSet merged = mergeScans(scene.scans, poses);
  const Index expected =
      scene.scans[0].size() - 1 + scene.scans[1].size() + scene.scans[2].size() + scene.scans[4].size();
  ASSERT_EQ(merged.size(), expected);
  ASSERT_EQ(merged.viewpoints.cols(), expected);
  ASSERT_EQ(merged.colors.cols(), expected);
  for (Index i = 0; i < expected; ++i) {
    const auto station = static_cast<std::size_t>(merged.intensities[i]);
    EXPECT_LT((merged.viewpoints.col(i).cast<double>() - scene.truth[station].translation()).norm(), 1e-4);
    if (merged.normals.col(i).allFinite()) {
      EXPECT_GE(merged.normals.col(i).dot(merged.viewpoints.col(i) - merged.points.col(i)), -1e-5f);
    }
  }
  EXPECT_THROW(mergeScans(scene.scans, {}), std::invalid_argument);
}

TEST(MergeScans, LargeCoordinatesStayExact)
{
  const ScannedScene scene = test::scanTwoRooms(2000);
  Eigen::Isometry3d far = scene.truth[0];
  far.translation() += Eigen::Vector3d(500000.0, 5000000.0, 100.0);
  const PointSet merged = mergeScans({scene.scans[0]}, {far.matrix()});
  for (Index i = 0; i < merged.size(); i += 50) {
    const Eigen::Vector3d world = merged.origin + merged.points.col(i).cast<double>();
    EXPECT_LT((world - far * scene.scans[0].points.col(i).cast<double>()).norm(), 1e-4);
  }
}

TEST(MergeScans, ScansInLargeCoordinatesStayExact)
{
  // The scans themselves are far away, as in UTM coordinates, and hardly moved.
  ScannedScene scene = test::scanTwoRooms(2000);
  PointSet& scan = scene.scans[0];
  scan.origin = {500000.0, 5000000.0, 100.0};
  scan.viewpoints = Points::Zero(3, 1);
  Eigen::Isometry3d small = Eigen::Isometry3d::Identity();
  small.translation() << 0.5, -0.25, 0.125;
  const PointSet merged = mergeScans({scan}, {small.matrix()});
  ASSERT_EQ(merged.size(), scan.size());
  for (Index i = 0; i < merged.size(); i += 50) {
    const Eigen::Vector3d world = merged.origin + merged.points.col(i).cast<double>();
    EXPECT_LT((world - small * (scan.origin + scan.points.col(i).cast<double>())).norm(), 1e-4);
  }
}
} // namespace
} // namespace fresco
