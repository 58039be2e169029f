// SPDX-License-Identifier: BSD-3-Clause
#include "common/shapes.h"
#include "surface/optimization/optimization_shapes.h"
#include "test_data.h"
#include <cstdlib>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/surface/core/normal_filtering.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
namespace fresco {
namespace {
int runTool(const std::string& arguments, const std::string& folder, const std::string& before = "")
{
  const std::string command = before + test::buildFolder() + "/bin/fresco_optimize " + arguments + " >" + folder +
                              "/stdout.txt 2>" + folder + "/stderr.txt";
  const int code = std::system(command.c_str());
  return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
}

TEST(Optimize, DoesWhatTheCoreDoes)
{
  const std::string folder = test::scratchFolder();
  const TriangleMesh mesh = test::roundedCube(10, 0.3);
  const PointSet points = test::cubePoints(3000, 0.01);
  writeMesh(folder + "/mesh.ply", mesh);
  writePoints(folder + "/points.ply", points);
  const std::string files = folder + "/mesh.ply " + folder + "/points.ply " + folder + "/out.ply";
  ASSERT_EQ(runTool(files + " -iterations 3 -flip -report " + folder + "/report.json", folder), 0);
  NormalFilteringOptions options;
  options.iterations = 3;
  options.flip = true;
  EXPECT_EQ(readMesh(folder + "/out.ply").vertices, filterSurface(mesh, points, options).mesh.vertices);
  const auto report = nlohmann::json::parse(readFile(folder + "/report.json"));
  EXPECT_GE(report.at("steps").size(), 3U);
  EXPECT_EQ(report.at("vertices"), mesh.vertexCount());
  EXPECT_TRUE(report.at("steps")[0].at("tangential").is_number());
}

TEST(Optimize, SaysThatFacesWereInsideOut)
{
  const std::string folder = test::scratchFolder();
  TriangleMesh mesh = test::roundedCube(10, 0.3);
  const auto said = [&] {
    writeMesh(folder + "/mesh.ply", mesh);
    EXPECT_EQ(runTool(folder + "/mesh.ply " + folder + "/points.ply " + folder + "/out.ply", folder), 0);
    return readFile(folder + "/stderr.txt").find("inside out") != std::string::npos;
  };
  writePoints(folder + "/points.ply", test::cubePoints(3000, 0.01));
  EXPECT_FALSE(said());
  mesh.faces.row(1).swap(mesh.faces.row(2));
  EXPECT_TRUE(said());
}

TEST(Optimize, OptionsAreNamedAndChecked)
{
  const std::string folder = test::scratchFolder(), files = "mesh.ply points.ply out.ply ";
  ASSERT_EQ(runTool("-h", folder), 0);
  const std::string help = readFile(folder + "/stdout.txt");
  for (const char* const option : {"-iterations", "-kappa1", "-kappa2", "-flip", "-tolerance", "-report"})
    EXPECT_NE(help.find(option), std::string::npos) << option;
  for (const char* const wrong : {"-iterations -1", "-iterations 0", "-iterations 9", "-tolerance -1", "-kappa1 -1",
                                  "-kappa2 -1", "-mode energy", "-nonsense"})
    EXPECT_EQ(runTool(files + wrong, folder), 2) << wrong;
}

TEST(Optimize, BadInputEndsCleanly)
{
  const std::string folder = test::scratchFolder();
  writeMesh(folder + "/mesh.ply", test::roundedCube(4, 0.3));
  PointSet points = test::cubePoints(100, 0.0);
  writePoints(folder + "/points.ply", points);
  points.points.array() += 1000.f;
  writePoints(folder + "/far.ply", points);
  const std::string mesh = folder + "/mesh.ply ", out = folder + "/out.ply";
  EXPECT_EQ(runTool(mesh + folder + "/far.ply " + out, folder), 1);
  EXPECT_NE(readFile(folder + "/stderr.txt").find("mesh.ply"), std::string::npos);
  EXPECT_EQ(runTool(mesh + folder + "/absent.ply " + out, folder), 1);
  EXPECT_EQ(runTool(folder + "/points.ply " + folder + "/points.ply " + out, folder), 1);
  EXPECT_EQ(runTool(mesh + folder + "/points.ply", folder), 2);
  EXPECT_EQ(runTool("-h", folder), 0);
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Optimize, WhatMemoryDoesNotHoldIsRefusedBeforeTheWork)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer wants an address space without limit";
#endif
  const std::string folder = test::scratchFolder();
  const TriangleMesh mesh = test::sphere(1.f, 9); // 2 million faces: 0.8 GB
  writeMesh(folder + "/mesh.ply", mesh);
  PointSet points;
  points.points = mesh.vertices.leftCols(1000);
  writePoints(folder + "/points.ply", points);
  ASSERT_GT(optimizationMemory(mesh.faceCount(), 1000), std::size_t{700000} << 10);
  EXPECT_EQ(optimizationMemory(2 * mesh.faceCount(), 2000), 2 * optimizationMemory(mesh.faceCount(), 1000));
  const std::string out = folder + "/out.ply";
  EXPECT_EQ(runTool(folder + "/mesh.ply " + folder + "/points.ply " + out + " -quiet", folder, "ulimit -v 700000 && "),
            1);
  const std::string error = readFile(folder + "/stderr.txt");
  EXPECT_NE(error.find("MB of memory"), std::string::npos) << error;
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
  EXPECT_FALSE(std::filesystem::exists(out));
}
} // namespace
} // namespace fresco
