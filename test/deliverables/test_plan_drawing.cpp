// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/plan_shapes.h"
#include <fresco/deliverables/core/plan_drawing.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
namespace {
using namespace fresco;
using namespace fresco::test;

TriangleMesh room()
{
  RoomBuilder b;
  b.openWall({0, 0}, {4, 0}, 2.5, {1, 2, 0, 2});
  b.wall({4, 0}, {4, 3}, 0, 2.5);
  b.wall({4, 3}, {0, 3}, 0, 2.5);
  b.wall({0, 3}, {0, 0}, 0, 2.5);
  b.slabs({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, 2.5);
  return b.mesh();
}

TEST(PlanDrawing, TablesTellTheRooms)
{
  const FloorPlan plan = drawPlan(room());
  const auto json = nlohmann::json::parse(planJson(plan));
  ASSERT_EQ(json["rooms"].size(), 1u);
  EXPECT_NEAR(json["rooms"][0]["area"].get<double>(), 12, 1e-3);
  EXPECT_NEAR(json["rooms"][0]["height"].get<double>(), 2.5, 1e-3);
  EXPECT_EQ(json["rooms"][0]["walls"].size(), 4u);
  std::istringstream csv(planCsv(plan));
  std::string head, line, more;
  std::getline(csv, head);
  std::getline(csv, line);
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(line.begin(), line.end(), ','));
  EXPECT_FALSE(std::getline(csv, more));
}

TEST(PlanDrawing, DoorsAreGapsInTheWalls)
{
  const FloorPlan plan = drawPlan(room());
  const std::string dxf = planDxf(plan);
  std::istringstream lines(dxf);
  std::string code, value, kind, layer, last;
  double length = 0, x = 0, y = 0, px = 0, py = 0;
  int vertices = 0;
  while (std::getline(lines, code) && std::getline(lines, value)) { // pairs of lines
    last = value;
    if (code == "0") {
      if (kind == "VERTEX" && layer == "WALLS" && ++vertices > 1)
        length += std::hypot(x - px, y - py);
      px = x, py = y;
      kind = value;
      vertices = kind == "POLYLINE" ? 0 : vertices;
    } else if (code == "8") {
      layer = value;
    } else if (code == "10") {
      x = std::stod(value);
    } else if (code == "20") {
      y = std::stod(value);
    }
  }
  EXPECT_EQ(last, "EOF");
  EXPECT_NEAR(length, 14 - 1, 2 * plan.cell);
}

TEST(PlanDrawing, SvgIsInMetresAndMarksAreNoTags)
{
  const FloorPlan plan = drawPlan(room());
  const std::string svg = planSvg(plan, {{{1, 1}, "<b>&"}});
  EXPECT_NE(svg.find("4.0000,3.0000"), std::string::npos);
  EXPECT_NE(svg.find("&lt;b&gt;&amp;"), std::string::npos);
  EXPECT_EQ(svg.find("<b>"), std::string::npos);
  EXPECT_NE(svg.find("12.00 m\u00b2"), std::string::npos);
}

TEST(PlanDrawing, EverythingLiesOnTheSheet)
{
  TriangleMesh moved = room();
  moved.origin = {50, -30, 0};
  const std::string svg = planSvg(drawPlan(moved), {{{51, -29}, "mark"}});
  double sheet[4];
  std::istringstream box(svg.substr(svg.find("viewBox=\"") + 9));
  for (double& value : sheet)
    box >> value;
  const auto lies = [&](double x, double y) {
    return x >= sheet[0] && y >= sheet[1] && x <= sheet[0] + sheet[2] && y <= sheet[1] + sheet[3];
  };
  const std::regex text("<text x=\"([^\"]*)\" y=\"([^\"]*)\""), point("(-?[0-9.]+),(-?[0-9.]+)[ \"]");
  int texts = 0, points = 0;
  for (std::sregex_iterator at(svg.begin(), svg.end(), text); at != std::sregex_iterator(); ++at, ++texts)
    EXPECT_TRUE(lies(std::stod((*at)[1]), std::stod((*at)[2]))) << at->str();
  for (std::sregex_iterator at(svg.begin(), svg.end(), point); at != std::sregex_iterator(); ++at, ++points)
    EXPECT_TRUE(lies(std::stod((*at)[1]), -std::stod((*at)[2]))) << at->str();
  EXPECT_GT(texts, 4);
  EXPECT_GT(points, 10);
}

TEST(PlanDrawing, PicturesAreTrueToScale)
{
  TriangleMesh mesh = room();
  mesh.origin = {100, 200, 0};
  mesh.colors = Colors::Constant(3, mesh.vertexCount(), 40);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    if (mesh.vertices(0, v) < 1e-3f)
      mesh.colors(0, v) = 240; // redder towards x = 0
  TexturedMesh model;
  model.mesh = mesh;
  model.texcoord_faces = Faces::Constant(3, mesh.faceCount(), -1);
  model.face_atlas.setConstant(mesh.faceCount(), -1);
  const FloorPlan plan = drawPlan(mesh);
  const ScaledPicture picture = orthophoto(model, plan, 0.02);
  EXPECT_NEAR(picture.image.width, 4 / 0.02, 2);
  EXPECT_NEAR(picture.image.height, 3 / 0.02, 2);
  EXPECT_NEAR(picture.first_pixel.x() - 0.01, plan.low.x(), 1e-9) << "the corner of a pixel, not its centre";
  EXPECT_NEAR(picture.first_pixel.y() + 0.01, plan.high.y(), 1e-9);
  std::istringstream world(worldFile(picture));
  double a[6];
  for (double& value : a)
    world >> value;
  for (const double x : {100.5, 102.0, 103.5}) { // colours fall from 240 to 40 over 4 m
    const int column = static_cast<int>(std::lround((x - a[4]) / a[0])),
              row = static_cast<int>(std::lround((201.5 - a[5]) / a[3]));
    EXPECT_NEAR(picture.image.pixel(column, row)[0], 240 - 50 * (a[4] + a[0] * column - 100), 1.5) << x;
    EXPECT_EQ(picture.image.pixel(column, row)[1], 40);
  }
  EXPECT_THROW(orthophoto(model, plan, 0), std::invalid_argument);
  EXPECT_THROW(orthophoto(model, plan, 1e-6), std::invalid_argument);
  model.mesh.colors.resize(3, 0);
  EXPECT_THROW(orthophoto(model, plan, 0.02), std::invalid_argument);
  EXPECT_GT(planPicture(plan, 0.02).image.width, picture.image.width);
}

TEST(PlanDrawing, CloudsHaveOrthophotosWithoutGaps)
{
  PointSet cloud = scanOf(room(), 3000, 0.002);
  cloud.colors = Colors::Constant(3, cloud.size(), 77);
  const FloorPlan plan = drawPlan(cloud);
  const ScaledPicture picture = orthophoto(cloud, plan, 0.02);
  int holes = 0;
  for (int y = 10; y < picture.image.height - 10; ++y)
    for (int x = 10; x < picture.image.width - 10; ++x)
      holes += picture.image.pixel(x, y)[0] != 77;
  EXPECT_EQ(holes, 0);
}
} // namespace
