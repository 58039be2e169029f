// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/part_exchange.h"
#include "assembly/scan_assembly.h"
#include "pair/partial_alias.h"
#include "pair/self_alignment.h"
#include "registration/look_alike_scenes.h"
#include "scan/up_direction.h"
#include <fresco/registration/core/point_to_plane_registration.h>
#include <fresco/registration/core/scan_registration.h>
#include <gtest/gtest.h>
namespace fresco::registration {
using test::relativeError;
using test::ScannedScene;
namespace {
struct Planned {
  PreparedScan scan;
  PlanSpectrum plan;
};

std::vector<Planned> drawPlans(const std::vector<PointSet>& scans, double voxel = 0.04)
{
  std::vector<PreparedScan> prepared;
  std::vector<std::optional<PlanFrame>> frames;
  for (const PointSet& scan : scans) {
    prepared.push_back(prepareScan(scan, Thinning(voxel), 0));
    frames.push_back(findPlanFrame(prepared.back(), findPlanes(prepared.back())));
  }
  const PlanGrid grid = choosePlanGrid(frames, prepared);
  std::vector<Planned> planned;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    PlanSpectrum plan;
    if (frames[k])
      plan = PlanSpectrum(drawFloorPlan({{prepared[k], frames[k]->T_plan_scan}}, grid), *frames[k], grid);
    planned.push_back({prepared[k], plan});
  }
  return planned;
}

Eigen::Isometry3d truth(const ScannedScene& scene, const std::vector<Planned>& planned, std::size_t a, std::size_t b)
{
  const auto working = [&](std::size_t k) {
    return Eigen::Isometry3d(scene.truth[k] * Eigen::Translation3d(planned[k].scan.center));
  };
  return working(a).inverse() * working(b);
}

TEST(FloorPlans, OneOfTheFirstPosesIsRight)
{
  const ScannedScene scene = test::scanTwoRooms();
  const std::vector<Planned> planned = drawPlans(scene.scans);
  for (std::size_t a = 0; a < 3; ++a) // of one room
    for (std::size_t b = a + 1; b < 3; ++b) {
      double nearest = 1e9;
      for (const PoseHypothesis& pose : matchPlans(planned[a].plan, planned[b].plan, 4))
        nearest = std::min(nearest, poseDistance(pose.T_a_b, truth(scene, planned, a, b), planned[a].scan.size));
      EXPECT_LT(nearest, 0.3) << a << " and " << b; // a cell and a half
    }
}

TEST(FloorPlans, PairsAreAligned)
{
  const ScannedScene scene = test::scanTwoRooms();
  const std::vector<Planned> planned = drawPlans(scene.scans);
  const PairAlignment pair = alignByPlans({planned[0].scan, planned[0].plan}, {planned[1].scan, planned[1].plan}, {});
  ASSERT_FALSE(pair.hypotheses.empty());
  EXPECT_LT(poseDistance(pair.hypotheses[0].T_a_b, truth(scene, planned, 0, 1), planned[0].scan.size), 0.03);
}

TEST(FloorPlans, ScannersThatDidNotStandUprightHaveNone)
{
  ScannedScene scene = test::scanTwoRooms();
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 1, 0).normalized()).toRotationMatrix();
  const std::vector<Planned> planned = drawPlans({transformPoints(scene.scans[0], T), scene.scans[1]});
  EXPECT_TRUE(planned[0].plan.empty());
  EXPECT_TRUE(matchPlans(planned[0].plan, planned[1].plan, 4).empty());
}

TEST(FloorPlans, HeightsOfScannersDoNotDependOnTheVoxel)
{
  const ScannedScene scene = test::scanTwoRooms(60000);
  for (const double voxel : {0.03, 0.05, 0.08})
    for (std::size_t k = 0; k < scene.scans.size(); ++k) {
      const PreparedScan scan = prepareScan(scene.scans[k], Thinning(voxel), 0);
      const std::optional<PlanFrame> frame = findPlanFrame(scan, findPlanes(scan));
      ASSERT_TRUE(frame.has_value());
      EXPECT_NEAR(frame->height, scene.truth[k].translation().z(), 0.02) << voxel;
    }
}

// A scanner in a corridor, and its floor plan, drawn in the frame of the world.
struct CorridorScan {
  CorridorScan(const test::Boxes& boxes, double x)
      : pose(test::stationPose({x, 1.0, 1.6}, 0.0, 0.0)),
        scan(prepareScan(test::scanBoxes(boxes, pose, 20000, 0.004, static_cast<unsigned>(x) + 1), Thinning(0.06), 0)),
        T_world_scan(pose * Eigen::Translation3d(scan.center))
  {}
  FloorPlan draw(const PlanGrid& grid) const { return drawFloorPlan({{scan, T_world_scan.cast<float>()}}, grid); }

  Eigen::Isometry3d pose;
  PreparedScan scan;
  Eigen::Isometry3d T_world_scan; // from the working frame
};

// 24 m long, 2 m wide, as low as the highest layer of plans reaches.
test::Boxes corridor()
{
  test::Boxes boxes;
  test::addRoom(boxes, {-12, 0, 0}, {12, 2, 2.3}, std::numeric_limits<double>::quiet_NaN());
  return boxes;
}

// From six metres away, rays graze the walls that the other scanner sees best. Of the free cells at them most are left
// out, more with `inner_free`; and a ceiling is no wall.
TEST(FloorPlans, TwoScansOfACorridorHardlyContradictEachOther)
{
  const test::Boxes boxes = corridor();
  const CorridorScan a(boxes, -3.0), b(boxes, 3.0);
  PlanGrid grid;
  grid.cell = 0.2f;
  grid.side = 128;
  grid.height = 1.6f;
  const auto conflicts = [](const FloorPlan::Layer& occupied, const FloorPlan::Layer& free) {
    Index all = 0, both = 0;
    for (std::size_t i = 0; i < occupied.size(); ++i) {
      all += occupied[i];
      both += occupied[i] * free[i];
    }
    EXPECT_GT(all, 100);
    return 1.0 * both / all;
  };
  for (const bool inner_free : {false, true}) {
    grid.inner_free = inner_free;
    const FloorPlan first = a.draw(grid), second = b.draw(grid);
    const std::size_t middle = 5 * grid.side + (grid.side - 30); // of the corridor, at (-6 m, 1 m)
    for (int layer = 0; layer < plan_layers; ++layer) {
      EXPECT_EQ(first.occupied[layer][middle], 0) << layer;
      EXPECT_LT(conflicts(first.occupied[layer], second.free[layer]), inner_free ? 0.06 : 0.085) << layer;
      EXPECT_LT(conflicts(second.occupied[layer], first.free[layer]), inner_free ? 0.06 : 0.085) << layer;
    }
  }
}

struct TurnedScans {
  std::vector<PreparedScan> scans;
  std::vector<ScanPlanes> planes;
  std::vector<Eigen::Vector3f> up; // true
};

// Each turned in its own way.
TurnedScans turnedScans(const ScannedScene& scene, double voxel)
{
  TurnedScans turned;
  for (std::size_t k = 0; k < scene.scans.size(); ++k) {
    const Eigen::AngleAxisd turn(0.7 * static_cast<double>(k + 1), Eigen::Vector3d(1.0, k, -1.0).normalized());
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    T.topLeftCorner<3, 3>() = turn.toRotationMatrix();
    turned.scans.push_back(prepareScan(transformPoints(scene.scans[k], T), Thinning(voxel), 0));
    turned.planes.push_back(findPlanes(turned.scans.back()));
    turned.up.emplace_back((turn * scene.truth[k].linear().transpose().col(2)).cast<float>());
  }
  return turned;
}

void expectRightUps(const TurnedScans& turned, int least)
{
  const UpDirections ups = findUpDirections(turned.scans, turned.planes);
  int found = 0;
  for (std::size_t k = 0; k < ups.size(); ++k)
    if (ups[k]) {
      ++found;
      EXPECT_GT(ups[k]->dot(turned.up[k]), 0.99f) << k;
    }
  EXPECT_GE(found, least);
  const PlanFrames frames = findPlanFrames(turned.scans, 1);
  for (std::size_t k = 0; k < ups.size(); ++k)
    EXPECT_EQ(frames[k].has_value(), ups[k].has_value()) << k;
}

TEST(FloorPlans, ScansShowWhichWayWasUp)
{
  expectRightUps(turnedScans(test::scanTwoRooms(60000), 0.04), 3); // one that sees few tops stays open
}

// Lamps and the heads of doors are seen from below, but they are narrow.
TEST(FloorPlans, DenseScansShowWhichWayWasUp)
{
  ScannedScene scene;
  for (const double width : {2.4, 3.1, 3.7}) {
    test::Boxes boxes;
    test::addRoom(boxes, {0, 0, 0}, {9, width, 2.6}, std::numeric_limits<double>::quiet_NaN());
    for (const double x : {0.6, 2.8, 5.0, 7.2}) {
      test::addBox(boxes, {x, 1.1, 2.5}, {x + 1.2, 1.25, 2.6});
      for (const double y : {0.0, width - 0.08})
        test::addBox(boxes, {x, y, 2.05}, {x + 0.9, y + 0.08, 2.6});
    }
    test::addBox(boxes, {3.8, 1.7, 0}, {4.6, 2.3, 0.7});
    const auto number = static_cast<unsigned>(scene.scans.size());
    scene.truth.push_back(test::stationPose({2.0 + 2.0 * number, 0.8, 1.5}, 0.3 + number, 0.02));
    scene.scans.push_back(test::scanBoxes(boxes, scene.truth.back(), 300000, 0.002, number + 1));
  }
  expectRightUps(turnedScans(scene, 0.02), 2);
}

// An equal room behind two doors is a partial alias, however dense the scan is.
TEST(FloorPlans, EqualRoomsBehindDoorsArePartialAliases)
{
  const Eigen::Isometry3d half_turn(Eigen::Translation3d(10, 4, 0) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  for (const bool equal : {true, false})
    for (const Index rays : {15000, 60000}) {
      const ScannedScene scene = test::facingRooms({equal, false, false, test::Paint::none}, rays).scene;
      const std::vector<Planned> planned = drawPlans(scene.scans, registrationVoxel(scene.scans[0]));
      int partial = 0;
      for (std::size_t i = 0; i < planned.size(); ++i) {
        const Eigen::Isometry3d T_world_scan(scene.truth[i] * Eigen::Translation3d(planned[i].scan.center));
        for (const ScanAlias& alias : findAliasesByPlan({planned[i].scan, planned[i].plan}))
          if (alias.partial) {
            ++partial;
            EXPECT_LT(poseDistance(T_world_scan * alias.T * T_world_scan.inverse(), half_turn, 2.0), 0.5);
          }
      }
      EXPECT_EQ(partial > 0, equal) << rays;
    }
}

// Scans of equal rooms fit each other best, but those in front of the doors show that there are three.
TEST(FloorPlans, ScansOfEqualRoomsInARowFallApart)
{
  const ScannedScene scene = test::roomsInARow(false, 60000).scene;
  std::vector<Planned> planned = drawPlans(scene.scans);
  std::vector<PreparedScan> scans;
  for (Planned& one : planned) {
    one.scan.aliases = findAliasesByPlan({one.scan, one.plan});
    scans.push_back(one.scan);
  }
  std::vector<PairAlignment> pairs;
  for (std::size_t a = 0; a < scans.size(); ++a)
    for (std::size_t b = a + 1; b < scans.size(); ++b) {
      pairs.push_back(alignByPlans({scans[a], planned[a].plan}, {scans[b], planned[b].plan}, {}));
      pairs.back().a = static_cast<Index>(a);
      pairs.back().b = static_cast<Index>(b);
    }
  sharePartialAliases(scans, pairs);
  GraphOptions options;
  options.tolerance = 4.f * scans[0].levels.back().voxel;
  const GraphInput input(scans, pairs, options);
  ScanGraph graph = assembleScans(input);
  partSecondPlaces(input, {}, graph);
  for (const ScanCluster& cluster : graph.clusters)
    for (std::size_t k = 1; k < cluster.scans.size(); ++k)
      EXPECT_LT(poseDistance(cluster.poses[0].inverse() * cluster.poses[k],
                             truth(scene, planned, cluster.scans[0], cluster.scans[k]), 2.0),
                0.3)
          << cluster.scans[0] << " and " << cluster.scans[k];
}
} // namespace

// More than 30 scans, in two rooms with different furniture.
TEST(FloorPlans, ManyScansArePlacedWhateverTheThreads)
{
  constexpr int across = 4, along = 8;
  const test::Boxes boxes = test::twoRooms();
  ScannedScene scene;
  for (int i = 0; i < across * along; ++i) {
    const double x = 0.9 + 6.8 * (i / across) / (along - 1), y = 0.8 + 2.4 * (i % across) / (across - 1);
    scene.truth.push_back(test::stationPose({x, y, 1.5}, 0.7 * i, 0.02));
    scene.scans.push_back(test::scanBoxes(boxes, scene.truth.back(), 6000, 0.004, static_cast<unsigned>(i) + 1));
  }
  ScanRegistrationOptions options;
  options.threads = 1;
  const auto alone = registerScans(scene.scans, {}, options);
  options.threads = 3;
  const auto result = registerScans(scene.scans, {}, options);
  const Index placed =
      std::count_if(result.poses.begin(), result.poses.end(), [](const Pose& pose) { return pose.has_value(); });
  EXPECT_GE(placed, 30);
  EXPECT_LT(relativeError(result.poses, scene).translation, 0.02);
  for (std::size_t k = 0; k < scene.scans.size(); ++k)
    EXPECT_EQ(alone.poses[k], result.poses[k]) << k;
}
} // namespace fresco::registration
