// SPDX-License-Identifier: BSD-3-Clause
#include "test_data.h"
#include "texture/texture_scene.h"
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <sys/wait.h>
namespace fresco::test {
namespace {
/// A cube, its cameras and photographs on disk.
struct Files {
  std::string folder = scratchFolder(), mesh = folder + "/cube.ply", cameras = folder + "/cameras",
              images = folder + "/images", messages = folder + "/messages.txt";

  Files()
  {
    const TriangleMesh scene = cube();
    writeMesh(mesh, scene);
    makeFolder(images);
    CameraSet set;
    set.cameras = {camera()};
    for (const TextureView& view : photographsAround(scene, waves)) {
      const std::string name = std::to_string(set.views.size()) + ".png";
      set.views.push_back({name, 0, view.T_camera_world});
      writeImage(images + "/" + name, view.image);
    }
    writeColmap(cameras, set);
  }

  int run(const std::string& arguments, const std::string& before = "") const
  {
    const std::string tool = before + buildFolder() + "/bin/fresco_texture";
    const int status = std::system((tool + " " + arguments + " > " + messages + " 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  int texture(const std::string& out, const std::string& options = "") const
  {
    return run(mesh + " " + cameras + " " + images + " " + folder + "/" + out + " " + options);
  }

  bool says(const std::string& text) const { return readFile(messages).find(text) != std::string::npos; }
};

TEST(TextureTool, WritesObjAndGlb)
{
  const Files files;
  for (const std::string name : {"model.obj", "model.glb"}) {
    ASSERT_EQ(files.texture(name), 0) << readFile(files.messages);
    const TexturedMesh model = readTexturedMesh(files.folder + "/" + name);
    EXPECT_EQ(model.mesh.faceCount(), 12);
    EXPECT_LT(colorError(model, waves).mean, 2.0) << name;
  }
  EXPECT_EQ(readImage(files.folder + "/model_mask.png").width,
            readTexturedMesh(files.folder + "/model.obj").atlases[0].width);
}

TEST(TextureTool, TilesHaveAtlasesOfTheirOwn)
{
  const Files files;
  for (const std::string name : {"model.obj", "model.glb"}) {
    ASSERT_EQ(files.texture(name, "-tile_faces 4"), 0) << readFile(files.messages);
    const TexturedMesh model = readTexturedMesh(files.folder + "/" + name);
    EXPECT_EQ(model.mesh.faceCount(), 12);
    EXPECT_GE(model.atlases.size(), 3U);
    EXPECT_LT(colorError(model, waves).mean, 2.0) << name;
    EXPECT_EQ(readImage(files.folder + "/model_mask_0.png").width, model.atlases[0].width);
  }
  EXPECT_EQ(files.texture("model.obj", "-tile_faces 4 -uv keep"), 2);
  EXPECT_EQ(files.texture("model.obj", "-tile_faces -4"), 2);
}

TEST(TextureTool, KnownPosesWithoutPointsAndAnOptionOfOldScripts)
{
  const Files files;
  writeFile(files.cameras + "/points3D.txt", "");
  ASSERT_EQ(files.texture("model.glb", "-no_examples"), 0) << readFile(files.messages);
  EXPECT_LT(colorError(readTexturedMesh(files.folder + "/model.glb"), waves).mean, 2.0);
}

TEST(TextureTool, TilesThatFailLeaveNothing)
{
  const Files files;
  TriangleMesh away = cube(); // no camera sees it
  away.origin = {1000, 1000, 0};
  writeMesh(files.folder + "/away.ply", away);
  EXPECT_EQ(files.run(files.folder + "/away.ply " + files.cameras + " " + files.images + " " + files.folder +
                      "/model.obj -tile_faces 4"),
            1);
  EXPECT_TRUE(files.says("none of the"));
  for (const auto& entry : std::filesystem::directory_iterator(files.folder))
    EXPECT_EQ(entry.path().filename().string().find("model"), std::string::npos) << entry.path();
}

TEST(TextureTool, HelpAndWrongUsage)
{
  const Files files;
  EXPECT_EQ(files.run("-h"), 0);
  EXPECT_TRUE(files.says("-texel"));
  EXPECT_EQ(files.run("one two"), 2);
  EXPECT_EQ(files.texture("model.obj", "-unknown 3"), 2);
  EXPECT_EQ(files.texture("model.xyz"), 2);
}

TEST(TextureTool, BadInputIsNamed)
{
  const Files files;
  std::filesystem::remove(files.images + "/3.png");
  EXPECT_EQ(files.texture("model.obj"), 1);
  EXPECT_TRUE(files.says("3.png"));
  writeImage(files.images + "/3.png", Image(64, 48));
  EXPECT_EQ(files.texture("model.obj"), 1);
  EXPECT_TRUE(files.says("3.png") && files.says("64x48") && files.says("200x200"));
  std::filesystem::remove_all(files.cameras);
  EXPECT_EQ(files.texture("model.obj"), 1);
  EXPECT_TRUE(files.says("cameras"));
  EXPECT_FALSE(std::filesystem::exists(files.folder + "/model.obj"));
}

TEST(TextureTool, TextureCoordinatesAreKept)
{
  const Files files;
  writeFile(files.folder + "/uv.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nvt 0.1 0.2\nvt 0.8 0.2\nvt 0.1 0.9\nf 1/1 2/2 3/3\n");
  const auto keep = [&](const std::string& mesh) {
    return files.run(files.folder + "/" + mesh + " " + files.cameras + " " + files.images + " " + files.folder +
                     "/model.obj -uv keep");
  };
  ASSERT_EQ(keep("uv.obj"), 0) << readFile(files.messages);
  const TexturedMesh model = readTexturedMesh(files.folder + "/model.obj");
  EXPECT_EQ(model.texcoords(0, 1), 0.8f);
  writeFile(files.folder + "/bare.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n");
  EXPECT_EQ(keep("bare.obj"), 1);
  EXPECT_TRUE(files.says("no texture coordinates"));
  EXPECT_EQ(keep("cube.ply"), 1);
  EXPECT_EQ(files.texture("model.obj", "-uv other"), 2);
  EXPECT_EQ(files.texture("model.obj", "-uv keep -texel 0.1"), 2);
}

TEST(TextureTool, MasksBesideThePhotographs)
{
  const Files files;
  for (const std::string& masks : {files.folder + "/masks", files.images + "/masks"}) {
    makeFolder(masks);
    writeImage(masks + "/3.png", Image(200, 200, 3, 255));
    writeImage(masks + "/4.png.png", Image(200, 200, 1, 255));
    ASSERT_EQ(files.texture("model.obj"), 0) << readFile(files.messages);
    EXPECT_TRUE(files.says("masks of 2 photographs"));
    writeImage(masks + "/3.png", Image(64, 48));
    EXPECT_EQ(files.texture("model.obj"), 1);
    EXPECT_TRUE(files.says("masks/3.png") && files.says("64x48") && files.says("200x200"));
    writeFile(masks + "/3.png", "no image");
    EXPECT_EQ(files.texture("model.obj"), 1);
    EXPECT_TRUE(files.says("masks/3.png"));
    std::filesystem::remove_all(masks);
  }
}

TEST(TextureTool, AVertexThatIsNoPlaceIsNamed)
{
  const Files files;
  writeFile(files.mesh,
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 1\n1 nan 1\n0 1 1\n3 0 1 2\n");
  EXPECT_EQ(files.texture("model.obj"), 1);
  EXPECT_TRUE(files.says("cube.ply") && files.says("vertex 1 is not finite")) << readFile(files.messages);
}

TEST(TextureTool, NoPhotographSeesTheMesh)
{
  const Files files;
  TriangleMesh far = cube();
  far.vertices.colwise() += Eigen::Vector3f(100, 100, 0);
  writeMesh(files.mesh, far);
  EXPECT_EQ(files.texture("model.obj"), 1);
  EXPECT_TRUE(files.says("cube.ply"));
  EXPECT_FALSE(std::filesystem::exists(files.folder + "/model.obj"));
}

TEST(TextureTool, WhatMemoryDoesNotHoldIsRefusedBeforeTheWork)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer wants an address space without limit";
#endif
  const Files files;
  TriangleMesh mesh = cube();
  const Faces one = mesh.faces;
  mesh.faces = one.replicate(1, 1500000 / one.cols()); // 0.2 GB or more from points, 0.8 from photographs
  writeMesh(files.folder + "/large.ply", mesh);
  PointSet points;
  points.points = mesh.vertices;
  points.colors = Colors::Random(3, points.size());
  writePoints(files.folder + "/points.ply", points);
  const std::string large = files.folder + "/large.ply ", out = files.folder + "/out.glb";
  for (const std::string& sources : {"-points " + files.folder + "/points.ply", files.cameras + " " + files.images}) {
    EXPECT_EQ(files.run(large + sources + " " + out + " -quiet", "ulimit -v 300000 && "), 1);
    const std::string error = readFile(files.messages);
    EXPECT_NE(error.find("MB of memory"), std::string::npos) << error;
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

TEST(TextureTool, UnwritableFolder)
{
  const Files files;
  EXPECT_EQ(files.texture("absent/model.obj"), 1);
  EXPECT_TRUE(files.says("absent"));
}
} // namespace
} // namespace fresco::test
