// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/plan_shapes.h"
#include "plan/outline.h"
#include <fresco/deliverables/core/plan.h>
#include <fresco/simulation/scene/scene.h>
#include <gtest/gtest.h>
#include <limits>
namespace {
using namespace fresco;
using namespace fresco::test;
using Eigen::Vector2d;

const std::vector<Vector2d> kite = {{0, 0}, {6, 0}, {6.5, 4.2}, {-0.4, 3.6}}; // no right angle but none

double lengthOf(const Eigen::Matrix3Xd& line)
{
  double sum = 0;
  for (Index k = 0; k + 1 < line.cols(); ++k)
    sum += (line.col(k + 1) - line.col(k)).norm();
  return sum;
}

/// Whether two plans have the same bits.
void expectSame(const FloorPlan& a, const FloorPlan& b)
{
  ASSERT_EQ(a.rooms.size(), b.rooms.size());
  for (std::size_t r = 0; r < a.rooms.size(); ++r) {
    EXPECT_EQ(a.rooms[r].outline, b.rooms[r].outline);
    EXPECT_EQ(a.rooms[r].area, b.rooms[r].area);
  }
}

TEST(CutMesh, ARoomIsOneClosedLineWithTheFreeSideOnItsLeft)
{
  RoomBuilder b;
  b.room(kite, 2.5);
  TriangleMesh mesh = b.mesh();
  mesh.origin = {1000, -500, 20};
  const auto lines = cutMesh(mesh, Eigen::Vector3d::UnitZ(), 21.1);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].col(0), lines[0].col(lines[0].cols() - 1));
  double perimeter = 0;
  std::vector<Vector2d> corners;
  for (std::size_t k = 0; k < kite.size(); ++k)
    perimeter += (kite[(k + 1) % kite.size()] - kite[k]).norm();
  for (Index k = 0; k + 1 < lines[0].cols(); ++k)
    corners.push_back(lines[0].col(k).head<2>() - Vector2d(1000, -500));
  EXPECT_NEAR(lengthOf(lines[0]), perimeter, 1e-5);
  EXPECT_NEAR(areaOf(corners), areaOf(kite), 1e-5); // positive: counter-clockwise
  EXPECT_TRUE(cutMesh(mesh, Eigen::Vector3d::UnitZ(), 30).empty());
}

TEST(CutMesh, AnOpenSurfaceGivesOpenLines)
{
  RoomBuilder b;
  b.wall({0, 0}, {2, 0}, 0, 2);
  const auto lines = cutMesh(b.mesh(), Eigen::Vector3d::UnitX(), 0.5);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NEAR(lengthOf(lines[0]), 2, 1e-6);
  EXPECT_THROW(cutMesh(b.mesh(), {0, 0, 2}, 1), std::invalid_argument);
  EXPECT_THROW(cutMesh(b.mesh(), Eigen::Vector3d::UnitZ(), NAN), std::invalid_argument);
}

TEST(Plan, RoomsDoorsAndWindowsOfTwoRooms)
{
  const FloorPlan plan = drawPlan(twoRooms());
  EXPECT_TRUE(plan.has_ceiling);
  EXPECT_NEAR(plan.ceiling - plan.floor, 2.6, 1e-4);
  ASSERT_EQ(plan.rooms.size(), 2u);
  EXPECT_NEAR(plan.rooms[0].area, 12, 1e-3);
  EXPECT_NEAR(plan.rooms[1].area, 9, 1e-3);
  std::vector<int> doors(2, 0), windows(2, 0);
  for (int r = 0; r < 2; ++r)
    for (const PlanWall& wall : plan.rooms[r].walls) {
      EXPECT_TRUE(wall.straight);
      for (const PlanOpening& opening : wall.openings) {
        ++(opening.is_door ? doors : windows)[r];
        EXPECT_EQ(opening.beyond, opening.is_door ? 1 - r : -1);
        EXPECT_NEAR((opening.to - opening.from).norm(), opening.is_door ? 0.9 : 1.5, 2 * plan.cell);
        EXPECT_NEAR(opening.head, opening.is_door ? 2.0 : 2.1, 0.051);
        EXPECT_NEAR(opening.sill, opening.is_door ? 0.0 : 0.9, 0.051);
      }
    }
  EXPECT_EQ(doors, (std::vector<int>{1, 1}));
  EXPECT_EQ(windows, (std::vector<int>{1, 0}));
}

TEST(Plan, ThreeWallsAreLeftWhereTheirNeighboursMeetBeforeTheFourth)
{
  const auto edge = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& point,
                       const Eigen::Vector2d& direction) {
    plan::OutlineEdge result;
    result.from = from, result.to = to, result.point = point, result.direction = direction;
    result.seen = true;
    return result;
  };
  const std::vector<PlanWall> walls = plan::joinEdges(
      {edge({0, 0}, {4, 0}, {0, 0}, {1, 0}), edge({4, 0}, {4, 0.08}, {4.03, 0}, {0, 1}), // beyond the corner
       edge({4, 0.08}, {0, 3}, {0, 3}, {-0.8, 0.6}), edge({0, 3}, {0, 0}, {0, 3}, {0, -1})},
      {}, plan::PlanePoints({}), {});
  ASSERT_EQ(walls.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d corners[] = {{0, 0}, {4, 0}, {0, 3}};
    EXPECT_LT((walls[k].from - corners[k]).norm(), 1e-9);
    EXPECT_LT((walls[k].to - corners[(k + 1) % 3]).norm(), 1e-9);
  }
}

TEST(Plan, WallsKeepTheirAnglesWhereTheDataHaveThem)
{
  RoomBuilder b;
  b.room(kite, 2.5);
  const FloorPlan plan = drawPlan(b.mesh());
  ASSERT_EQ(plan.rooms.size(), 1u);
  EXPECT_NEAR(plan.rooms[0].area, areaOf(kite), 1e-3 * areaOf(kite));
  EXPECT_EQ(plan.rooms[0].walls.size(), 4u);
  EXPECT_GE(plan.directions.size(), 3u); // nothing forces right angles
}

TEST(Plan, MovedAndTurnedInputGivesAMovedAndTurnedPlan)
{
  const TriangleMesh mesh = twoRooms();
  const FloorPlan plan = drawPlan(mesh);
  TriangleMesh moved = mesh;
  moved.vertices = Eigen::AngleAxisf(0.4f, Eigen::Vector3f::UnitZ()).toRotationMatrix() * mesh.vertices;
  moved.origin = {4e5, 5e6, 100};
  const FloorPlan other = drawPlan(moved);
  ASSERT_EQ(other.rooms.size(), plan.rooms.size());
  for (std::size_t r = 0; r < plan.rooms.size(); ++r)
    EXPECT_NEAR(other.rooms[r].area, plan.rooms[r].area, 2e-3 * plan.rooms[r].area);
  EXPECT_NEAR(other.height - plan.height, 100, 1e-3);
  EXPECT_NEAR(std::remainder(other.directions[0] - plan.directions[0] - 0.4 * 180 / M_PI, 90), 0, 0.02);
  const Vector2d turned = Eigen::Rotation2Dd(0.4) * plan.rooms[0].label + Vector2d(4e5, 5e6);
  EXPECT_LT((other.rooms[0].label - turned).norm(), 0.3);
}

TEST(Plan, UpMayBeAnyAxisAndTheFloorIsMadeLevel)
{
  const TriangleMesh mesh = twoRooms();
  TriangleMesh lying = mesh;
  const Eigen::AngleAxisf tilt(0.02f, Eigen::Vector3f(0.6f, 0.8f, 0)); // 1.1 degrees
  const Eigen::AngleAxisf quarter(static_cast<float>(M_PI / 2), Eigen::Vector3f::UnitX());
  lying.vertices = (quarter * tilt).toRotationMatrix() * mesh.vertices;
  PlanOptions options;
  options.up = -Eigen::Vector3d::UnitY();
  const FloorPlan plan = drawPlan(lying, options);
  ASSERT_EQ(plan.rooms.size(), 2u);
  EXPECT_NEAR(plan.rooms[0].area, 12, 0.02);
  EXPECT_NEAR(plan.rooms[0].ceiling - plan.rooms[0].floor, 2.6, 0.005);
}

TEST(Plan, NoisyCloudsGiveTheSameRooms)
{
  const PointSet cloud = scanOf(twoRooms(), 4000, 0.003);
  const FloorPlan plan = drawPlan(cloud);
  ASSERT_EQ(plan.rooms.size(), 2u);
  EXPECT_NEAR(plan.rooms[0].area, 12, 0.06); // half a per cent
  EXPECT_NEAR(plan.rooms[1].area, 9, 0.045);
  for (const PlanRoom& room : plan.rooms)
    for (const PlanWall& wall : room.walls) {
      EXPECT_TRUE(wall.straight);
      EXPECT_NEAR(wall.rms, 0.003, 0.001); // the noise, no more
    }
  EXPECT_GT(plan.points.cols(), 0);
}

TEST(Plan, ACylinderHasTheAreaOfACircle)
{
  std::vector<Vector2d> circle;
  for (int k = 0; k < 180; ++k)
    circle.emplace_back(2 * std::cos(k * M_PI / 90), 2 * std::sin(k * M_PI / 90));
  RoomBuilder b;
  b.room(circle, 3);
  const FloorPlan plan = drawPlan(b.mesh());
  ASSERT_EQ(plan.rooms.size(), 1u);
  EXPECT_NEAR(plan.rooms[0].area, areaOf(circle), 0.01 * areaOf(circle));
}

TEST(Plan, BeamsEndNoRoomAndLintelsDo)
{
  RoomBuilder beam, lintel;
  for (RoomBuilder* b : {&beam, &lintel})
    b->room({{0, 0}, {6, 0}, {6, 3}, {0, 3}}, 2.8);
  const auto across = [](RoomBuilder& b, double from, double to, double low) {
    b.wall({3, from}, {3, to}, low, 2.8);
    b.wall({3.2, to}, {3.2, from}, low, 2.8);
  };
  across(beam, 0, 3, 2.4);
  across(lintel, 0, 1, 0);
  across(lintel, 1, 2, 2.1);
  across(lintel, 2, 3, 0);
  EXPECT_EQ(drawPlan(beam.mesh()).rooms.size(), 1u);
  EXPECT_EQ(drawPlan(lintel.mesh()).rooms.size(), 2u);
}

TEST(Plan, LampsAboveFurnitureEndNoRoom)
{
  RoomBuilder b;
  b.room({{0, 0}, {9, 0}, {9, 1.8}, {0, 1.8}}, 2.6);
  const Vector2d corners[] = {{4, 0.6}, {4, 1.2}, {4.6, 1.2}, {4.6, 0.6}};
  for (int k = 0; k < 4; ++k) {
    b.wall(corners[k], corners[(k + 1) % 4], 2.3, 2.6);
    b.wall(corners[k], corners[(k + 1) % 4], 0, 0.9);
  }
  const FloorPlan plan = drawPlan(b.mesh());
  ASSERT_EQ(plan.rooms.size(), 1u);
  EXPECT_NEAR(plan.rooms[0].area, 9 * 1.8, 1e-3);
}

TEST(Plan, WallsGoOnWhereTheirOtherFaceShowsThroughAGap)
{
  RoomBuilder b;
  b.wall({0, 0}, {4, 0}, 0, 2.6), b.wall({4, 3}, {0, 3}, 0, 2.6), b.wall({0, 3}, {0, 0}, 0, 2.6);
  b.openWall({4, 0}, {4, 3}, 2.6, {0.5, 2.5, 0, 2.6});
  b.slabs({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, 2.6);
  b.room({{4.1, 0}, {7.1, 0}, {7.1, 3}, {4.1, 3}}, 2.6);
  const FloorPlan plan = drawPlan(b.mesh());
  ASSERT_EQ(plan.rooms.size(), 2u);
  EXPECT_NEAR(plan.rooms[0].area, 12, 0.01);
  EXPECT_NEAR(plan.rooms[1].area, 9, 1e-3);
  double unseen = 0;
  for (const PlanWall& wall : plan.rooms[0].walls)
    unseen += wall.seen ? 0 : (wall.to - wall.from).norm();
  EXPECT_NEAR(unseen, 2, 0.1); // told, not made up
}

TEST(Plan, WithoutCeilingRoomsEndAtNarrowPassages)
{
  RoomBuilder b;
  b.openWall({3, 0}, {3, 3}, 2.2, {1, 1.9, 0, 2.2});
  b.openWall({3.1, 3}, {3.1, 0}, 2.2, {1.1, 2, 0, 2.2});
  b.wall({0, 0}, {3, 0}, 0, 2.2), b.wall({3, 3}, {0, 3}, 0, 2.2), b.wall({0, 3}, {0, 0}, 0, 2.2);
  b.wall({3.1, 0}, {6, 0}, 0, 2.2), b.wall({6, 0}, {6, 3}, 0, 2.2), b.wall({6, 3}, {3.1, 3}, 0, 2.2);
  b.quad({0, 0, 0}, {6, 0, 0}, {6, 3, 0}, {0, 3, 0});
  const FloorPlan plan = drawPlan(b.mesh());
  EXPECT_FALSE(plan.has_ceiling);
  ASSERT_EQ(plan.rooms.size(), 2u);
  EXPECT_NEAR(plan.rooms[0].area + plan.rooms[1].area, 9 + 8.7, 0.2);
}

TEST(Plan, GeneratedFloorsHaveTheAreaOfTheirCeilings)
{
  for (const int seed : {1, 2}) {
    simulation::OfficeOptions office;
    office.rooms = 6;
    office.seed = seed;
    const TriangleMesh mesh = simulation::makeOffice(office).mesh;
    double ceilings = 0;
    for (Index f = 0; f < mesh.faceCount(); ++f)
      if (const Eigen::Vector3d normal = areaVector(mesh, f);
          normal.z() < -0.999 * normal.norm() && std::abs(faceCorner(mesh, f, 0).z() - 2.6) < 1e-4)
        ceilings -= normal.z() / 2;
    const FloorPlan plan = drawPlan(mesh);
    EXPECT_EQ(plan.rooms.size(), 7u) << seed; // with the corridor
    double area = 0;
    for (const PlanRoom& room : plan.rooms)
      area += room.area;
    EXPECT_NEAR(area, ceilings, 0.005 * ceilings) << seed;
  }
}

TEST(Plan, DoesNotDependOnThreads)
{
  PlanOptions one, four;
  one.threads = 1;
  four.threads = 4;
  expectSame(drawPlan(twoRooms(), one), drawPlan(twoRooms(), four));
}

TEST(Plan, RefusesWhatItCannotDraw)
{
  const TriangleMesh mesh = twoRooms();
  const auto refuses = [&](const auto& change) {
    PlanOptions options;
    change(options);
    EXPECT_THROW(drawPlan(mesh, options), std::invalid_argument);
  };
  refuses([](PlanOptions& o) { o.tolerance = 0; });
  refuses([](PlanOptions& o) { o.tolerance = NAN; });
  refuses([](PlanOptions& o) { o.cell = 0.3; });
  refuses([](PlanOptions& o) { o.door = -1; });
  refuses([](PlanOptions& o) { o.up.setZero(); });
  refuses([](PlanOptions& o) { o.height = INFINITY; });
  try {
    PlanOptions options;
    options.height = 7;
    drawPlan(mesh, options);
    FAIL() << "a height above the model";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("from 0 to 2.6 m"), std::string::npos) << error.what();
  }
  EXPECT_THROW(drawPlan(TriangleMesh()), std::invalid_argument);
  EXPECT_THROW(drawPlan(PointSet()), std::invalid_argument);
  PointSet lost;
  lost.points = Points::Constant(3, 5, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THROW(drawPlan(lost), std::invalid_argument);
}

TEST(Plan, OnePointIsNoRoom)
{
  PointSet point;
  point.points = Points::Zero(3, 1);
  EXPECT_TRUE(drawPlan(point).rooms.empty());
}
} // namespace
