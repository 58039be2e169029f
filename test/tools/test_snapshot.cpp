// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/picture_fixtures.h"
#include "test_data.h"
#include <cstdlib>
#include <filesystem>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
namespace fresco {
namespace {
using namespace test;
namespace fs = std::filesystem;

struct Outcome {
  int status = -1; ///< exit status, or -1 if the program died of a signal
  std::string errors, output;
};

class SnapshotTool : public testing::Test {
protected:
  SnapshotTool() : folder_(scratchFolder()), mesh_(folder_ + "/ball.ply"), out_(folder_ + "/out.png")
  {
    writeMesh(mesh_, sphere(1.f, 4));
  }

  std::string slurp(const std::string& path) const { return fs::file_size(path) > 0 ? readFile(path) : ""; }

  Outcome run(const std::string& arguments, const std::string& environment = "") const
  {
    const std::string errors = folder_ + "/stderr.txt", output = folder_ + "/stdout.txt";
    const std::string command = "env -u DISPLAY " + environment + " '" + buildFolder() + "/bin/fresco_snapshot' " +
                                arguments + " >'" + output + "' 2>'" + errors + "'";
    const int result = std::system(command.c_str());
    return {WIFEXITED(result) ? WEXITSTATUS(result) : -1, slurp(errors), slurp(output)};
  }

  /// Exit status 1, one line on stderr with `word`, no picture left.
  void expectFailure(const std::string& arguments, const std::string& word, const std::string& environment = "") const
  {
    const Outcome result = run("-quiet " + arguments, environment);
    EXPECT_EQ(result.status, 1) << arguments << ": " << result.errors;
    EXPECT_NE(result.errors.find(word), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_FALSE(fs::exists(out_)) << arguments;
  }

  void write(const std::string& path, const std::string& text) const
  {
    OutputFile file(path);
    file.write(text);
    file.commit();
  }

  std::string folder_, mesh_, out_;
};

TEST_F(SnapshotTool, WritesAPictureOfTheSizeAskedFor)
{
  const Outcome result = run(mesh_ + " " + out_ + " -size 321x123");
  ASSERT_EQ(result.status, 0) << result.errors;
  const Image image = readImage(out_);
  EXPECT_EQ(image.width, 321);
  EXPECT_EQ(image.height, 123);
  const std::string jpeg = folder_ + "/out.jpg";
  EXPECT_EQ(run(mesh_ + " " + jpeg + " -size 64x48 -quiet").errors, "");
  EXPECT_EQ(readImage(jpeg).width, 64);
}

TEST_F(SnapshotTool, SeveralShadingsGoIntoFilesOfTheirOwn)
{
  const Outcome result =
      run(mesh_ + " " + out_ + " -size 320x240 -shading normals,wireframe,error,points -reference " + mesh_);
  ASSERT_EQ(result.status, 0) << result.errors;
  for (const char* name : {"normals", "wireframe", "error", "points"})
    EXPECT_EQ(readImage(folder_ + "/out_" + name + ".png").width, 320) << name;
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(SnapshotTool, EyeLookUpAndAngleAreHonoured)
{
  const std::string view = " -size 40x40 -shading normals -quiet -look 0 0 0 -angle 5 -eye ";
  ASSERT_EQ(run(mesh_ + " " + out_ + view + "0 -4 0").status, 0);
  EXPECT_LE(difference(rgb(readImage(out_), 20, 20), {128, 0, 128}), 8);
  ASSERT_EQ(run(mesh_ + " " + out_ + view + "0 0 4 -up 0 1 0").status, 0);
  EXPECT_LE(difference(rgb(readImage(out_), 20, 20), {128, 128, 255}), 8);
}

TEST_F(SnapshotTool, IndoorViewsAndTexturesOfAFile)
{
  TriangleMesh room;
  addBox(room, {0, 0, 0}, {5, 4, 2.5f}, true);
  addBox(room, {2, 1.5f, 0}, {3, 2.5f, 0.7f}, false);
  writeMesh(folder_ + "/room.ply", room);
  for (const char* view : {"inside", "above"}) {
    const Outcome result = run(folder_ + "/room.ply " + out_ + " -size 160x120 -view " + view);
    EXPECT_EQ(result.status, 0) << result.errors;
  }
  PointSet points;
  points.points = room.vertices;
  writePoints(folder_ + "/points.ply", points);
  const std::string inside = folder_ + "/points.ply " + out_ + " -size 160x120 -view inside";
  EXPECT_EQ(run(inside + " -room " + folder_ + "/room.ply").status, 0);
  fs::remove(out_);
  expectFailure(inside, "-room");
  EXPECT_EQ(run(mesh_ + " " + out_ + " -room " + folder_ + "/room.ply").status, 2);
  TexturedMesh square = texturedSquare(Image(16, 16, 3, 60));
  for (const char* name : {"/square.obj", "/square.glb"}) {
    writeTexturedMesh(folder_ + name, square);
    const Outcome result = run(folder_ + name + " " + out_ + " -size 60x60 -shading texture -view top -quiet");
    ASSERT_EQ(result.status, 0) << result.errors;
    EXPECT_LE(difference(rgb(readImage(out_), 30, 30), {60, 60, 60}), 2) << name;
  }
}

TEST_F(SnapshotTool, PointCloudsAreDrawn)
{
  PointSet set;
  set.points = sphere(1.f, 5).vertices;
  for (const char* name : {"/cloud.pcd", "/cloud.ply", "/cloud.xyz"}) {
    writePoints(folder_ + name, set);
    const Outcome result = run(folder_ + name + " " + out_ + " -size 160x120 -background 0 0 0");
    ASSERT_EQ(result.status, 0) << result.errors;
    EXPECT_GT(difference(rgb(readImage(out_), 80, 60), {0, 0, 0}), 20) << name;
  }
}

TEST_F(SnapshotTool, HelpNamesEveryOption)
{
  const Outcome result = run("-h");
  EXPECT_EQ(result.status, 0);
  for (const char* option :
       {"-shading", "-reference", "-size", "-eye", "-look", "-up", "-angle", "-view", "-transparent", "-cull", "-room",
        "-no_colors", "-limit", "-unit", "-background", "-threads", "-quiet"})
    EXPECT_NE(result.output.find(option), std::string::npos) << option;
}

TEST_F(SnapshotTool, WrongUsageEndsWithTwo)
{
  for (const std::string& arguments :
       {std::string("-bogus"), mesh_, mesh_ + " " + out_ + " -shading phong", mesh_ + " " + out_ + " -size 10",
        mesh_ + " " + out_ + " -size 0x5", mesh_ + " " + out_ + " -view nowhere", mesh_ + " " + out_ + " -look 0 0 0",
        mesh_ + " " + out_ + " -shading error", mesh_ + " " + folder_ + "/out.gif", mesh_ + " " + out_ + " -eye 1 2",
        mesh_ + " " + out_ + " -background 1 2 300", mesh_ + " " + folder_ + "/out.jpg -transparent"}) {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments << ": " << result.errors;
    EXPECT_FALSE(fs::exists(out_));
  }
  writeTexturedMesh(folder_ + "/square.obj", texturedSquare(Image(16, 16, 3, 60)));
  const std::string texture = readFile(folder_ + "/square.png");
  for (const char* shading : {"texture", "normals"})
    EXPECT_EQ(run(folder_ + "/square.obj " + folder_ + "/square.png -shading " + shading).status, 2);
  EXPECT_EQ(readFile(folder_ + "/square.png"), texture);
}

TEST_F(SnapshotTool, BadInputEndsWithOneLineAndNoPicture)
{
  expectFailure(folder_ + "/missing.ply " + out_, "missing.ply");
  write(folder_ + "/empty.ply", " ");
  expectFailure(folder_ + "/empty.ply " + out_, "empty.ply");
  const std::string whole = readFile(mesh_);
  write(folder_ + "/cut.ply", whole.substr(0, whole.size() / 2));
  expectFailure(folder_ + "/cut.ply " + out_, "cut.ply");
  write(folder_ + "/nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expectFailure(folder_ + "/nan.obj " + out_, "nan.obj");
  expectFailure(folder_ + " " + out_, folder_);
  expectFailure(mesh_ + " " + out_ + " -shading texture", "ball.ply");
  expectFailure(mesh_ + " " + out_ + " -shading error -reference " + folder_ + "/missing.ply", "missing.ply");
  expectFailure(mesh_ + " " + folder_ + "/no/such/folder/out.png", "folder");
  expectFailure(mesh_ + " " + out_ + " -size 60000x60000", "60000");
  EXPECT_EQ(run(mesh_ + " " + out_ + " -oversampling 9").status, 2);
}

TEST_F(SnapshotTool, WithoutEglThereIsAClearError)
{
  expectFailure(mesh_ + " " + out_, "EGL", "__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json");
  expectFailure(mesh_ + " " + out_, "EGL",
                "LIBGL_DRIVERS_PATH=/nonexistent GBM_BACKENDS_PATH=/nonexistent GALLIUM_DRIVER=none");
}

TEST_F(SnapshotTool, ADeadDisplayDoesNotMatter)
{
  EXPECT_EQ(run(mesh_ + " " + out_ + " -size 64x48", "DISPLAY=:77").status, 0);
}

TEST_F(SnapshotTool, RealModels)
{
  FRESCO_NEED_DATA("fandisk.obj");
  const std::string fandisk = dataFolder() + "/fandisk.obj";
  const Outcome result = run(fandisk + " " + out_ + " -shading gouraud,error -reference " + fandisk);
  ASSERT_EQ(result.status, 0) << result.errors;
  const Image image = readImage(folder_ + "/out_error.png");
  const auto color = rgb(image, 400, 400); // the distance to itself is zero
  EXPECT_GT(color[0], 80);
  EXPECT_LT(color[1] + color[2], 30);
}
} // namespace
} // namespace fresco
