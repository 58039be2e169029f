// SPDX-License-Identifier: BSD-3-Clause
// Every tool against what users get wrong: exit status 1 or 2, one line on stderr that names file and reason, no output
// left behind, no death by a signal.
#include "tools/tool_runs.h"
#include <fresco/io/file.h>
namespace {
using namespace fresco;
using namespace fresco::test;

TEST(Tools, HelpIsPrintedAndWrongUsageIsTwo)
{
  const std::string folder = soundFolder();
  for (const std::string& tool : tools()) {
    const Outcome help = run(folder, tool + " -h");
    EXPECT_EQ(help.status, 0) << tool;
    EXPECT_EQ(help.err, "") << tool;
    for (const char* part : {"usage: fresco_", "-threads", "-quiet"})
      EXPECT_NE(help.out.find(part), std::string::npos) << tool << ": " << part;
    for (const char* wrong : {"", " -nonsense 1 a b c d", " a b c d e f g -threads", " a b c d -threads x"}) {
      const Outcome outcome = run(folder, tool + wrong);
      EXPECT_EQ(outcome.status, 2) << tool << wrong << "\n" << outcome.err;
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << tool << wrong << "\n" << outcome.err;
    }
  }
}

TEST(Tools, BadClouds)
{
  const std::string folder = soundFolder();
  for (const std::string bad :
       {"missing.pcd", "empty.pcd", "cut.pcd", "noise.pcd", "pointless.pcd", "cut.ply", "mesh.doc", "images"})
    for (const std::string command : {"filter BAD out.pcd", "normals BAD out.pcd", "reconstruct BAD out.ply",
                                      "optimize mesh.ply BAD out.ply", "register BAD -o out"}) {
      std::string line = command;
      line.replace(line.find("BAD"), 3, bad);
      expectRefused(folder, line, bad);
    }
}

TEST(Tools, BadMeshes)
{
  const std::string folder = soundFolder();
  for (const std::string bad :
       {"missing.ply", "empty.ply", "cut.ply", "noise.ply", "pointless.ply", "mesh.doc", "images"})
    for (const std::string command :
         {"compare BAD mesh.ply", "compare mesh.ply BAD", "snapshot BAD out.png", "texture BAD cameras images out.obj",
          "optimize BAD cloud.pcd out.ply", "scan BAD out"}) {
      std::string line = command;
      line.replace(line.find("BAD"), 3, bad);
      expectRefused(folder, line, bad);
    }
  expectRefused(folder, "compare cloud.pcd mesh.ply", "cloud.pcd");
  expectRefused(folder, "snapshot mesh.ply out.png -shading error -reference missing.ply", "missing.ply");
  expectRefused(folder, "snapshot mesh.ply out.png -shading texture", "mesh.ply");
}

TEST(Tools, UnwritableOutput)
{
  const std::string folder = soundFolder();
  put(folder + "/file", "in the way");
  fs::create_directories(folder + "/in/scans");
  fs::copy(folder + "/cloud.pcd", folder + "/in/scans");
  for (const char* name : {"cameras", "images", "poses.txt"})
    fs::copy(folder + "/" + name, folder + "/in/" + name);
  for (const std::string command :
       {"filter cloud.pcd none/out.pcd", "normals cloud.pcd none/out.pcd",
        "reconstruct cloud.pcd none/out.ply -depth 4", "texture mesh.ply cameras images none/out.obj",
        "texture mesh.ply cameras images none/out.glb", "snapshot mesh.ply none/out.png",
        "optimize mesh.ply mesh.ply none/out.ply", "compare mesh.ply mesh.ply -json none/out.json",
        "compare mesh.ply mesh.ply -colored none/out.ply"})
    expectRefused(folder, command, "none/out");
  for (const std::string command :
       {"register cloud.pcd -o file", "scan mesh.ply file -stations 1", "model in file -use_poses"})
    expectRefused(folder, command, "file");
  EXPECT_EQ(get(folder + "/file"), "in the way");
}

TEST(Tools, WrongKindOfOutput)
{
  const std::string folder = soundFolder();
  for (const std::string command :
       {"filter cloud.pcd out.doc", "normals cloud.pcd out.doc", "reconstruct cloud.pcd out.doc -depth 4",
        "texture mesh.ply cameras images out.doc", "snapshot mesh.ply out.doc", "optimize mesh.ply mesh.ply out.doc"}) {
    const auto before = listing(folder);
    const Outcome outcome = run(folder, command + " -quiet");
    EXPECT_TRUE(outcome.status == 1 || outcome.status == 2) << command << outcome.status;
    EXPECT_NE(outcome.err.find("out.doc"), std::string::npos) << command << outcome.err;
    EXPECT_EQ(listing(folder), before) << command;
  }
}

TEST(Tools, PointsThatAreNotFinite)
{
  const std::string folder = soundFolder();
  PointSet cloud = readPoints(folder + "/cloud.pcd");
  cloud.points.col(5).setConstant(std::numeric_limits<float>::quiet_NaN());
  cloud.points(1, 9) = std::numeric_limits<float>::infinity();
  cloud.normals.col(20).setConstant(std::numeric_limits<float>::quiet_NaN());
  writePoints(folder + "/some.pcd", cloud);
  for (const std::string command :
       {"filter some.pcd out.pcd -outliers 8 2", "normals some.pcd out.pcd", "reconstruct some.pcd out.ply -depth 4"})
    EXPECT_EQ(run(folder, command).status, 0) << command;
  cloud.points.setConstant(std::numeric_limits<float>::quiet_NaN());
  writePoints(folder + "/all.pcd", cloud);
  fs::remove(folder + "/out.pcd");
  fs::remove(folder + "/out.ply");
  for (const std::string command : {"normals all.pcd out.pcd", "reconstruct all.pcd out.ply"}) {
    const Outcome outcome = run(folder, command + " -quiet");
    EXPECT_TRUE(outcome.status == 1 || (outcome.status == 0 && command[0] == 'n')) << command << outcome.err;
  }
  EXPECT_EQ(run(folder, "register all.pcd cloud.pcd -o out -quiet").status, 0);
  EXPECT_EQ(get(folder + "/out/poses.txt").substr(0, 5), "none\n"); // a scan that cannot be placed is said so
}

TEST(Tools, ViewpointThatIsNotFinite)
{
  const std::string folder = soundFolder();
  std::string cloud = get(folder + "/cloud.pcd");
  const std::size_t line = cloud.find("VIEWPOINT"), end = cloud.find('\n', line);
  cloud.replace(line, end - line, "VIEWPOINT 0 nan 0 1 0 0 0");
  put(folder + "/unseen.pcd", cloud);
  expectRefused(folder, "normals unseen.pcd out.pcd", "unseen.pcd");
  expectRefused(folder, "filter unseen.pcd out.pcd -veil 10", "unseen.pcd");
  for (const std::string elsewhere : {" -viewpoint 0 0 9", " -propagate"})
    EXPECT_EQ(run(folder, "normals unseen.pcd out.pcd -quiet" + elsewhere).status, 0) << elsewhere;
}

TEST(Tools, CloudWithoutNormalsCannotBeReconstructed)
{
  const std::string folder = soundFolder();
  PointSet bare;
  bare.points = test::sphere(1.f, 3).vertices;
  writePoints(folder + "/bare.pcd", bare);
  expectRefused(folder, "reconstruct bare.pcd out.ply", "bare.pcd");
}

TEST(Tools, PhotographsThatDoNotFit)
{
  const std::string folder = soundFolder();
  writeImage(folder + "/images/a.png", Image(32, 24, 3, 128));
  expectRefused(folder, "texture mesh.ply cameras images out.obj", "a.png");
  put(folder + "/images/a.png", "no image");
  expectRefused(folder, "texture mesh.ply cameras images out.obj", "a.png");
  fs::remove(folder + "/images/a.png");
  expectRefused(folder, "texture mesh.ply cameras images out.obj", "a.png");
  expectRefused(folder, "texture mesh.ply images images out.obj", "images");
  put(folder + "/cameras/images.txt", "1 0 0 0 0 0 0 4 1 a.png\n\n");
  expectRefused(folder, "texture mesh.ply cameras images out.obj", "images.txt");
}

TEST(Tools, PointsWithoutALookGiveNoTexture)
{
  const std::string folder = soundFolder();
  put(folder + "/grey.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  expectRefused(folder, "texture mesh.ply -points grey.xyz out.obj", "neither colours nor intensities");
  put(folder + "/black.xyz", "0 0 0 0 0 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n");
  expectRefused(folder, "texture mesh.ply -points black.xyz out.obj", "all black");
  put(folder + "/equal.xyz", "0 0 1 7\n1 0 0 7\n0 1 0 7\n");
  expectRefused(folder, "texture mesh.ply -points equal.xyz out.obj", "all equal");
  put(folder + "/behind.xyz", "nan 0 1 7 7 7\n1 nan 0 1 2 3\n");
  expectRefused(folder, "texture mesh.ply -points behind.xyz out.obj", "no point lies");
  put(folder + "/far.xyz", "100 0 1 7 7 7\n100 0 2 1 2 3\n");
  expectRefused(folder, "texture mesh.ply -points far.xyz out.obj", "far.xyz: no part of mesh.ply is covered");
  expectRefused(folder, "texture mesh.ply -points cut.pcd out.obj", "cut.pcd");
}

TEST(Tools, ModelInputThatDoesNotFit)
{
  const std::string folder = soundFolder();
  expectRefused(folder, "model missing out", "missing");
  expectRefused(folder, "model images out", "images");
  fs::create_directories(folder + "/in/scans");
  expectRefused(folder, "model in out", "in: an empty folder");
  fs::copy(folder + "/cloud.pcd", folder + "/in/scans/scan_00.pcd");
  expectRefused(folder, "model in out -use_poses", "poses.txt");
  fs::create_directory(folder + "/in/panoramas");
  writeImage(folder + "/in/panoramas/scan_00.png", Image(64, 33));
  expectRefused(folder, "model in out", "64x33 pixels is not twice as wide as high");
  writeImage(folder + "/in/panoramas/scan_00.png", Image(64, 32));
  writeImage(folder + "/in/panoramas/scan_01.jpg", Image(64, 32));
  expectRefused(folder, "model in out", "scan_01.jpg: a panorama of no scan");
  fs::remove_all(folder + "/in/panoramas");
  fs::copy(folder + "/cameras", folder + "/in/cameras");
  expectRefused(folder, "model in out", "a.png");
  writePoses(folder + "/in/poses.txt", {Pose(), Pose()});
  expectRefused(folder, "model in out", "poses.txt");
  fs::create_directory(folder + "/rgbd");
  put(folder + "/rgbd/camera-intrinsics.txt", "585 0 320\n0 585 240\n0 0 1\n");
  expectRefused(folder, "model rgbd out", "rgbd");
  put(folder + "/rgbd/frame-000000.depth.png", "no image");
  expectRefused(folder, "model rgbd out", "depth.png");
}
} // namespace
