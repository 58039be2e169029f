// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/models.h"
#include "tools/cloud_tool.h"
#include <fresco/io/gltf.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
namespace fresco {
namespace {
using namespace test;

struct Simplify : CloudTool {
  Simplify() : CloudTool("simplify") {}
};

TEST_F(Simplify, MeshesAndTexturedModels)
{
  writeMesh(path("mesh.ply"), test::sphere(1, 4));
  ASSERT_EQ(run(path("mesh.ply") + " " + path("light.ply") + " -faces 200"), 0) << errors();
  EXPECT_LE(readMesh(path("light.ply")).faceCount(), 200);
  EXPECT_TRUE(meshTopology(readMesh(path("light.ply"))).watertight);
  writeTexturedMesh(path("model.obj"), test::texturedSquare(20));
  for (const char* name : {"light.obj", "light.glb"}) {
    ASSERT_EQ(run(path("model.obj") + " " + path(name) + " -error 0.001"), 0) << errors();
    const TexturedMesh light = readTexturedMesh(path(name));
    EXPECT_LT(light.mesh.faceCount(), 100);
    EXPECT_EQ(light.atlases.size(), 1u);
    EXPECT_LT(test::textureError(light), 1e-3);
  }
  ASSERT_EQ(run(path("mesh.ply") + " " + path("light.ply") + " -faces 999999"), 0);
  EXPECT_NE(errors().find("only"), std::string::npos) << errors();
  ASSERT_EQ(run(path("mesh.ply") + " " + path("light.ply") + " -faces 1"), 0);
  EXPECT_NE(errors().find("warning"), std::string::npos) << errors();
}

TEST_F(Simplify, BakesTheFullModel)
{
  TriangleMesh full = test::sphere(1, 5);
  full.colors.resize(3, full.vertexCount());
  full.colors.setConstant(90);
  writeMesh(path("full.ply"), full);
  text("world.txt", "1 0 0 1000 0 1 0 2000 0 0 1 30 0 0 0 1\n");
  ASSERT_EQ(run(path("full.ply") + " " + path("light.glb") + " -faces 500 -texel 0.02 -from " + path("full.ply") +
                " -to_world " + path("world.txt")),
            0)
      << errors();
  const GltfModel read = readGltf(path("light.glb"));
  const TexturedMesh& light = read.model;
  EXPECT_LE(light.mesh.faceCount(), 500);
  ASSERT_EQ(read.normal_maps.size(), 1u);
  EXPECT_FALSE(read.normal_maps[0].empty());
  EXPECT_NEAR(light.atlases[0].pixel(light.atlases[0].width / 3, light.atlases[0].height / 3)[0], 90, 4);
  const Eigen::Vector3d middle = light.mesh.origin + light.mesh.vertices.rowwise().mean().cast<double>();
  EXPECT_LT((middle - Eigen::Vector3d(1000, 2000, 30)).norm(), 0.05);
}

TEST_F(Simplify, BadInputEndsWithOneLineAndNoFile)
{
  writeMesh(path("mesh.ply"), test::sphere(1, 3));
  const std::string mesh = path("mesh.ply"), out = " " + path("result.ply"), glb = " " + path("result.glb");
  for (const std::string& arguments : std::vector<std::string>{
           mesh + out, mesh + out + " -faces -1", mesh + out + " -error x", mesh + " " + mesh + " -faces 9",
           mesh + " " + path("result.doc") + " -faces 9", mesh + out + " -from " + mesh,
           mesh + glb + " -faces 9 -atlas 1", mesh + out + " -faces 9 -to_world " + mesh})
    expectFailure(arguments, 2);
  for (const std::string& arguments : std::vector<std::string>{
           path("missing.ply") + out + " -faces 9", text("empty.ply", "") + out + " -faces 9",
           scanFile("scan.ply") + out + " -faces 9", mesh + glb + " -faces 9 -from " + path("missing.glb"),
           mesh + glb + " -faces 9 -to_world " + text("wrong.txt", "1 2 3\n"),
           mesh + " " + path("no/result.ply") + " -faces 9"})
    expectFailure(arguments, 1);
  expectFailure(text("mesh.doc", "x") + out + " -faces 9", 1);
  EXPECT_NE(errors().find(".ply"), std::string::npos) << errors(); // what is read
}

TEST_F(Simplify, LargeModelsBecomeTiles)
{
  writeMesh(path("mesh.ply"), test::sphere(1, 4));
  const std::string tileset = path("tiles/tileset.json");
  ASSERT_EQ(run(path("mesh.ply") + " " + tileset + " -faces 900"), 0) << errors();
  EXPECT_NE(readFile(tileset).find("tile_1.glb"), std::string::npos);
  EXPECT_LE(readTexturedMesh(path("tiles/tile_0.glb")).mesh.faceCount(), 900);
  expectFailure(path("mesh.ply") + " " + path("tileset.json") + " -error 0.1", 2);
  expectFailure(path("mesh.ply") + " " + path("tileset.json") + " -faces 9 -compress", 2);
}
} // namespace
} // namespace fresco
