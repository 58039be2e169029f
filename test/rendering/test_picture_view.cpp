// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/picture_fixtures.h"
#include <Eigen/Geometry>
#include <fresco/rendering/indoor_view.h>
#include <fresco/rendering/room_frame.h>
#include <gtest/gtest.h>
using namespace fresco::rendering;
namespace fresco {
namespace {
using namespace test;

/// Picture coordinates of a world point: -1..1 from left to right and from bottom to top; z is the depth.
Eigen::Vector3d pictured(const Viewpoint& view, double aspect, const Eigen::Vector3d& point)
{
  const Eigen::Matrix3d axes = cameraAxes(view.eye - view.look, view.up);
  const Eigen::Vector3d p = axes.transpose() * (point - view.eye);
  const double half = std::tan(view.angle * pi / 360);
  return {p.x() / (-p.z() * half * aspect), p.y() / (-p.z() * half), -p.z()};
}

/// Finely meshed box: its area does not hang on few faces.
void addPlate(TriangleMesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high, bool inward)
{
  addBox(mesh, low, high, inward);
}

/// Room of 6 x 4 x 2.6 with a table, a cupboard and a closed side, the floor at z = 0; faces show to the inside.
TriangleMesh furnishedRoom()
{
  TriangleMesh mesh;
  addPlate(mesh, {0, 0, 0}, {6, 4, 2.6f}, true);
  addPlate(mesh, {2, 1.5f, 0.7f}, {4, 2.5f, 0.75f}, false);
  addPlate(mesh, {5.4f, 0.5f, 0}, {6, 2, 2}, false);
  addPlate(mesh, {2.1f, 1.6f, 0}, {2.2f, 1.7f, 0.7f}, false);
  addPlate(mesh, {3.8f, 2.3f, 0}, {3.9f, 2.4f, 0.7f}, false);
  return mesh;
}

TriangleMesh turned(TriangleMesh mesh, const Eigen::Matrix3f& rotation)
{
  mesh.vertices = rotation * mesh.vertices;
  return mesh;
}

TEST(View, FrameHoldsTheModelAndTouchesTwoSides)
{
  TriangleMesh mesh = sphere(1.f, 3);
  mesh.vertices.row(0) *= 3.f;
  mesh.origin = {1000, -2000, 50};
  for (const std::string& name : viewNames())
    for (const double aspect : {0.5, 1.5}) {
      Framing framing;
      framing.direction = viewDirection(name);
      framing.aspect = aspect;
      framing.margin = 0.05;
      const Viewpoint view = frameView(mesh, framing);
      Eigen::Vector2d low(1, 1), high(-1, -1);
      for (Index v = 0; v < mesh.vertexCount(); ++v) {
        const Eigen::Vector3d p = pictured(view, aspect, mesh.origin + mesh.vertices.col(v).cast<double>());
        EXPECT_GT(p.z(), 0);
        low = low.cwiseMin(p.head<2>());
        high = high.cwiseMax(p.head<2>());
      }
      const double widest = (high - low).maxCoeff() / 2;
      EXPECT_NEAR(widest, 0.9, 1e-3) << name << " " << aspect; // 1 - 2 margins
      EXPECT_NEAR((low + high).norm(), 0, 1e-3) << name;
    }
}

TEST(View, NamedDirectionsFollowTheUprightDirection)
{
  EXPECT_TRUE(viewDirection("front").isApprox(Eigen::Vector3d(0, -1, 0)));
  const Eigen::Vector3d up = Eigen::Vector3d(1, 2, -1).normalized();
  EXPECT_NEAR(viewDirection("top", up).dot(up), 1, 1e-12);
  EXPECT_NEAR(viewDirection("left", up).dot(up), 0, 1e-12);
  EXPECT_THROW(viewDirection("sideways"), std::invalid_argument);
  EXPECT_THROW(viewDirection("top", Eigen::Vector3d::Zero()), std::invalid_argument);
}

TEST(View, AxesAreOrthonormalEvenLookingStraightDown)
{
  for (const Eigen::Vector3d& backward :
       {Eigen::Vector3d(0, 0, 3), Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(0, -4, 0)})
    for (const Eigen::Vector3d& up : {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(0, 1, 0)}) {
      const Eigen::Matrix3d axes = cameraAxes(backward, up);
      EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-12));
      EXPECT_NEAR(axes.determinant(), 1, 1e-12);
      EXPECT_NEAR(axes.col(2).dot(backward.normalized()), 1, 1e-12);
    }
}

TEST(View, StrayPointsDoNotDecideOnTheFrame)
{
  PointSet set;
  set.points = sphere(1.f, 4).vertices;
  const double distance = frameView(set).eye.norm();
  set.points.conservativeResize(3, set.points.cols() + 1);
  set.points.rightCols(1) << 500, 0, 0;
  EXPECT_NEAR(frameView(set).eye.norm(), distance, 0.02 * distance);
}

TEST(View, BadFramingIsRefused)
{
  const TriangleMesh mesh = sphere(1.f, 1);
  Framing framing;
  framing.angle = 0;
  EXPECT_THROW(frameView(mesh, framing), std::invalid_argument);
  framing = {};
  framing.aspect = 0;
  EXPECT_THROW(frameView(mesh, framing), std::invalid_argument);
  framing = {};
  framing.margin = 0.5;
  EXPECT_THROW(frameView(mesh, framing), std::invalid_argument);
  framing = {};
  framing.direction.setZero();
  EXPECT_THROW(frameView(mesh, framing), std::invalid_argument);
  EXPECT_THROW(frameView(PointSet{}), std::invalid_argument);
}

TEST(IndoorView, UprightDirectionIsFoundFromTheModel)
{
  EXPECT_GT(guessUp(furnishedRoom()).z(), 0.999);
  const Eigen::Matrix3f tilt = Eigen::AngleAxisf(0.3f, Eigen::Vector3f(1, 2, 0).normalized()).toRotationMatrix();
  EXPECT_GT(guessUp(turned(furnishedRoom(), tilt)).dot(tilt.cast<double>().col(2)), 0.999);
  Eigen::Matrix3f camera; // x right, y down, z forward
  camera << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const Eigen::Vector3d up = guessUp(turned(furnishedRoom(), camera));
  EXPECT_GT(up.dot(camera.cast<double>().col(2)), 0.999) << up.transpose();
}

TEST(IndoorView, RoomFrameFollowsTheWalls)
{
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.5f, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  const RoomFrame frame = findRoomFrame(turned(furnishedRoom(), turn));
  const Eigen::Vector3d wall = turn.cast<double>().col(0);
  EXPECT_GT(std::max(std::abs(frame.along.dot(wall)), std::abs(frame.across.dot(wall))), 0.999);
  EXPECT_NEAR(frame.up.dot(frame.along), 0, 1e-9);
}

void expectInsideTheRoom(const TriangleMesh& room, const Eigen::Matrix3d& rotation)
{
  const std::optional<Viewpoint> view = insideView(room);
  ASSERT_TRUE(view);
  const Eigen::Vector3d eye = rotation.transpose() * (view->eye - room.origin);
  const Eigen::Vector3d direction = rotation.transpose() * (view->look - view->eye);
  EXPECT_GT(eye.x(), 0.1);
  EXPECT_LT(eye.x(), 5.9);
  EXPECT_GT(eye.y(), 0.1);
  EXPECT_LT(eye.y(), 3.9);
  EXPECT_NEAR(eye.z(), 1.56, 0.4);
  EXPECT_FALSE(eye.x() > 5.4 && eye.y() > 0.5 && eye.y() < 2) << "in the cupboard";
  EXPECT_LT(direction.z(), 0); // slightly down
  // From where it stands it looks into the room, not at the wall behind: along the longer way.
  const Eigen::Vector2d level = direction.head<2>().normalized();
  const double ahead = std::min(std::abs(((level.x() > 0 ? 6 : 0) - eye.x()) / level.x()),
                                std::abs(((level.y() > 0 ? 4 : 0) - eye.y()) / level.y()));
  EXPECT_GT(ahead, 2.5);
}

TEST(IndoorView, InsideViewStandsInFreeSpaceAndLooksIntoTheRoom)
{
  TriangleMesh room = furnishedRoom();
  room.origin = {300, -70, 12};
  expectInsideTheRoom(room, Eigen::Matrix3d::Identity());
  Eigen::Matrix3f camera;
  camera << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  expectInsideTheRoom(turned(furnishedRoom(), camera), camera.cast<double>());
  TriangleMesh inside_out = furnishedRoom();
  inside_out.faces.row(0).swap(inside_out.faces.row(1));
  expectInsideTheRoom(inside_out, Eigen::Matrix3d::Identity());
}

TEST(IndoorView, NothingInsideASheet) { EXPECT_FALSE(insideView(texturedSquare(Image(1, 1)).mesh)); }

TEST(IndoorView, DoesNotDependOnThreads)
{
  const TriangleMesh room = furnishedRoom();
  IndoorOptions one, four;
  one.threads = 1;
  four.threads = 4;
  EXPECT_EQ(insideView(room, one)->eye, insideView(room, four)->eye);
  EXPECT_EQ(insideView(room, one)->look, insideView(room, four)->look);
  const auto [inside, above] = indoorViews(room, four);
  EXPECT_EQ(aboveView(room, one).eye, above.eye);
  EXPECT_EQ(insideView(room, one)->eye, inside->eye);
}

TEST(IndoorView, AboveViewShowsTheFloorThroughTheCeiling)
{
  const TriangleMesh room = furnishedRoom();
  PictureOptions options = optionsFor(Shading::Normals, 320, 240);
  options.view = aboveView(room);
  options.cull_back_faces = true;
  EXPECT_GT(options.view->eye.z(), 2.6);
  const Image image = renderPicture(room, options);
  int floor = 0, ceiling = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      floor += difference(rgb(image, x, y), {128, 128, 255}) <= 2;
      ceiling += difference(rgb(image, x, y), {128, 128, 0}) <= 2;
    }
  EXPECT_GT(floor, 320 * 240 / 8);
  EXPECT_EQ(ceiling, 0);
}

TEST(IndoorView, BadInputIsRefused)
{
  EXPECT_THROW(insideView(TriangleMesh{}), std::invalid_argument);
  EXPECT_THROW(aboveView(TriangleMesh{}), std::invalid_argument);
  IndoorOptions options;
  options.up = Eigen::Vector3d::Zero();
  EXPECT_THROW(insideView(furnishedRoom(), options), std::invalid_argument);
  options = {};
  options.aspect = -1;
  EXPECT_THROW(aboveView(furnishedRoom(), options), std::invalid_argument);
}
} // namespace
} // namespace fresco
