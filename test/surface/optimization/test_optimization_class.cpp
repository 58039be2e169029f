// SPDX-License-Identifier: BSD-3-Clause
#include "surface/optimization/optimization_shapes.h"
#include "test_data.h"
#include <cstdlib>
#include <fresco/core/pcl_conversions.h>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/surface/surface_optimization.h>
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <sys/wait.h>
namespace fresco {
namespace {
TEST(OptimizationClass, EqualsCore)
{
  const TriangleMesh mesh = test::roundedCube(10, 0.3);
  const PointSet points = test::cubePoints(3000, 0.01);
  const auto polygons = pcl::make_shared<pcl::PolygonMesh>();
  toPolygonMesh(mesh, *polygons);
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  toPointCloud(points, *cloud);
  SurfaceOptimization optimization;
  optimization.setInputMesh(polygons);
  optimization.setInputCloud(cloud);
  optimization.setMaximumIterations(3);
  optimization.setKappa1(0.5);
  optimization.setKappa2(0.2);
  optimization.setFlipEdges(true);
  optimization.setTolerance(1e-4);
  optimization.setNumberOfThreads(1);
  pcl::PolygonMesh output;
  optimization.process(output);

  SurfaceOptimizationOptions options;
  options.iterations = optimization.getMaximumIterations();
  options.kappa1 = optimization.getKappa1();
  options.kappa2 = optimization.getKappa2();
  options.flip = optimization.getFlipEdges();
  options.tolerance = optimization.getTolerance();
  options.mode = optimization.getMode();
  options.threads = optimization.getNumberOfThreads();
  const SurfaceOptimizationResult expected = optimizeSurface(mesh, points, options);
  EXPECT_EQ(toTriangleMesh(output).vertices, expected.mesh.vertices);
  EXPECT_EQ(toTriangleMesh(output).faces, expected.mesh.faces);
  EXPECT_EQ(optimization.getResult().steps.size(), expected.steps.size());
}

TEST(OptimizationClass, WithoutInputIsAnError)
{
  SurfaceOptimization optimization;
  pcl::PolygonMesh output;
  EXPECT_THROW(optimization.process(output), std::invalid_argument);
  EXPECT_THROW(optimization.setInputCloud(pcl::PointCloud<pcl::PointXYZ>::ConstPtr()), std::invalid_argument);
  const auto polygons = pcl::make_shared<pcl::PolygonMesh>();
  toPolygonMesh(test::roundedCube(4, 0.3), *polygons);
  optimization.setInputMesh(polygons);
  EXPECT_THROW(optimization.process(output), std::invalid_argument);
}

int runTool(const std::string& arguments, const std::string& folder)
{
  const std::string command = std::string(FRESCO_BINARY_DIR) + "/bin/fresco_optimize " + arguments + " >" + folder +
                              "/stdout.txt 2>" + folder + "/stderr.txt";
  const int code = std::system(command.c_str());
  return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
}

TEST(OptimizationTool, DoesWhatTheCoreDoes)
{
  const std::string folder = test::scratchFolder();
  const TriangleMesh mesh = test::roundedCube(10, 0.3);
  const PointSet points = test::cubePoints(3000, 0.01);
  writeMesh(folder + "/mesh.ply", mesh);
  writePoints(folder + "/points.ply", points);
  const std::string files = folder + "/mesh.ply " + folder + "/points.ply " + folder + "/out.ply";
  ASSERT_EQ(runTool(files + " -iterations 3 -flip -report " + folder + "/report.json", folder), 0);
  SurfaceOptimizationOptions options;
  options.iterations = 3;
  options.flip = true;
  EXPECT_EQ(readMesh(folder + "/out.ply").vertices, optimizeSurface(mesh, points, options).mesh.vertices);
  EXPECT_NE(readFile(folder + "/report.json").find("\"steps\""), std::string::npos);
  EXPECT_EQ(runTool(files + " -mode faithful -iterations 2 -quiet", folder), 0);
}

TEST(OptimizationTool, BadInputEndsCleanly)
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
  EXPECT_EQ(runTool(mesh + folder + "/points.ply " + out + " -mode other", folder), 2);
  EXPECT_EQ(runTool(mesh + folder + "/points.ply", folder), 2);
  EXPECT_EQ(runTool("-h", folder), 0);
  EXPECT_FALSE(std::filesystem::exists(out));
}
} // namespace
} // namespace fresco
