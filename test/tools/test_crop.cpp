// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/models.h"
#include "deliverables/plan_shapes.h"
#include "tools/cloud_tool.h"
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
namespace fresco {
namespace {
using namespace test;

struct Crop : CloudTool {
  Crop() : CloudTool("crop") {}
};

TEST_F(Crop, CloudsKeepEveryFieldOfThePointsInside)
{
  const std::string in = scanFile("scan.pcd");
  const PointSet before = readPoints(in);
  const float middle = before.points.row(0).segment(0, 40).mean();
  ASSERT_EQ(run(in + " " + path("result.pcd") + " -box " + std::to_string(middle) + " -100 -100 100 100 100"), 0)
      << errors();
  const PointSet after = readPoints(path("result.pcd"));
  EXPECT_EQ(fieldNames(readCloud(path("result.pcd"))), fieldNames(readCloud(in)));
  std::vector<Index> inside;
  for (Index i = 0; i < before.size(); ++i)
    if (before.points(0, i) >= middle)
      inside.push_back(i);
  ASSERT_GT(inside.size(), 0u);
  const PointSet truth = selectPoints(before, inside);
  EXPECT_TRUE(test::same(after.points, truth.points));
  EXPECT_TRUE(test::same(after.intensities, truth.intensities));
}

TEST_F(Crop, MeshesAndModelsOfAllFormats)
{
  writeMesh(path("mesh.ply"), test::square(3));
  writeTexturedMesh(path("model.glb"), test::texturedSquare(4));
  writeTexturedMesh(path("model.obj"), test::texturedSquare(4));
  text("part.geojson", "{\"type\":\"Polygon\",\"coordinates\":[[[0.25,0.25],[1.75,0.25],[1.75,1.75]]]}");
  for (const char* name : {"mesh.ply", "model.glb", "model.obj"}) {
    const std::string out = path(std::string("cut_") + name);
    ASSERT_EQ(run(path(name) + " " + out + " -polygon " + path("part.geojson") + " -above -1"), 0) << errors();
    const TriangleMesh mesh = name[1] == 'e' ? readMesh(out) : readTexturedMesh(out).mesh;
    EXPECT_NEAR(surfaceArea(mesh), 1.125, 1e-5) << name;
  }
  EXPECT_EQ(readTexturedMesh(path("cut_model.glb")).atlases.size(), 1u);
  ASSERT_EQ(run(path("model.glb") + " " + path("bare.ply") + " -above -1"), 0) << errors();
  EXPECT_EQ(readMesh(path("bare.ply")).faceCount(), 32);
}

TEST_F(Crop, RoomsOfMeshesAndClouds)
{
  const TriangleMesh rooms = test::twoRooms();
  writeMesh(path("rooms.ply"), rooms);
  writePoints(path("rooms.pcd"), test::scanOf(rooms, 3000, 0.002));
  ASSERT_EQ(run(path("rooms.ply") + " " + path("room.ply") + " -room 2"), 0) << errors();
  EXPECT_GT(readMesh(path("room.ply")).vertices.row(0).minCoeff(), 4.0);
  ASSERT_EQ(run(path("rooms.pcd") + " " + path("room.pcd") + " -room 2 -margin 0.03"), 0) << errors();
  const PointSet room = readPoints(path("room.pcd"));
  EXPECT_GT(room.points.row(0).minCoeff(), 4.0);
  EXPECT_GT(room.size(), 3000 * 2 * 3 * 3); // floor and ceiling, and its walls
  expectFailure(path("rooms.ply") + " " + path("result.ply") + " -room 3", 1);
  EXPECT_NE(errors().find("rooms.ply: crop: room 3 of 2 rooms"), std::string::npos) << errors();
  expectFailure(path("rooms.ply") + " " + path("result.ply") + " -room 1 -above 0", 2);
  expectFailure(path("rooms.ply") + " " + path("result.ply") + " -room 0", 2);
  expectFailure(path("rooms.ply") + " " + path("result.ply") + " -room 1 -height 9", 1);
}

TEST_F(Crop, BadInputEndsWithOneLineAndNoFile)
{
  const std::string good = scanFile("scan.pcd"), out = " " + path("result.pcd");
  for (const std::string options :
       {"", " -box 0 0 0 0 1 1", " -box 0 0 0 1 1", " -box 0 0 0 1 1 1 -above 1", " -above x"})
    expectFailure(good + out + options, 2);
  const std::string crossed =
      text("crossed.geojson", "{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[4,4],[4,0],[0,4]]]}");
  for (const std::string& options : std::vector<std::string>{
           " -box 1000 1000 1000 1001 1001 1001", " -above 2 -below 1", " -polygon " + crossed, " -polygon missing.svg",
           " -polygon " + text("empty.svg", "<svg/>"), " -polygon " + good})
    expectFailure(good + out + options, 1);
  EXPECT_NE(errors().find("scan.pcd"), std::string::npos);
  expectFailure(good + out + " -polygon " + crossed, 1);
  EXPECT_NE(errors().find("crossed.geojson"), std::string::npos);
  writeMesh(path("mesh.ply"), test::square(3));
  expectFailure(path("mesh.ply") + " " + path("result.doc") + " -above 0", 2);
  expectFailure(path("mesh.ply") + " " + path("mesh.ply") + " -above 0", 2);
  expectFailure(path("mesh.ply") + " " + path("no/result.ply") + " -above -1", 1);
  expectFailure(text("cut.glb", "glTF") + " " + path("result.glb") + " -above 0", 1);
}
} // namespace
} // namespace fresco
