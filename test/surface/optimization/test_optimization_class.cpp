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
#include <nlohmann/json.hpp>
#include <pcl/point_types.h>
#include <sys/wait.h>
namespace fresco {
namespace {
class OptimizationClass : public testing::Test {
protected:
  const TriangleMesh mesh = test::roundedCube(10, 0.3);
  const PointSet points = test::cubePoints(3000, 0.01);
  SurfaceOptimization optimization;
  pcl::PolygonMesh output;

  void SetUp() override
  {
    const auto polygons = pcl::make_shared<pcl::PolygonMesh>();
    toPolygonMesh(mesh, *polygons);
    const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
    toPointCloud(points, *cloud);
    optimization.setInputMesh(polygons);
    optimization.setInputCloud(cloud);
  }
};

TEST_F(OptimizationClass, EqualsCore)
{
  optimization.setMaximumIterations(3);
  optimization.setKappa1(0.5);
  optimization.setKappa2(0.2);
  optimization.setFlipEdges(true);
  optimization.setTolerance(1e-4);
  optimization.setNumberOfThreads(1);
  optimization.process(output);

  NormalFilteringOptions options;
  options.iterations = optimization.getMaximumIterations();
  options.smoothness_weight = optimization.getKappa1();
  options.tangential_weight = optimization.getKappa2();
  options.flip = optimization.getFlipEdges();
  options.tolerance = optimization.getTolerance();
  options.threads = optimization.getThreads();
  const NormalFilteringResult expected = filterSurface(mesh, points, options);
  EXPECT_EQ(toTriangleMesh(output).vertices, expected.mesh.vertices);
  EXPECT_EQ(toTriangleMesh(output).faces, expected.mesh.faces);
  EXPECT_EQ(optimization.getResult().iterations, expected.iterations);
  EXPECT_EQ(optimization.getNormalFilteringResult().flipped_edges, expected.flipped_edges);
  EXPECT_EQ(optimization.getNormalFilteringOptions().smoothness_weight, 0.5);
}

TEST_F(OptimizationClass, EqualsCoreInModeEnergy)
{
  EnergyOptions options;
  options.iterations = 3;
  options.kappa1 = 0.2;
  optimization.setMode(OptimizationMode::energy);
  optimization.setOptions(options);
  bool told = false;
  optimization.setProgress([&](std::string_view, double) { return told = true; });
  optimization.process(output);
  const EnergyResult expected = minimizeSurfaceEnergy(mesh, points, options);
  EXPECT_EQ(toTriangleMesh(output).vertices, expected.mesh.vertices);
  EXPECT_EQ(optimization.getResult().iterations, expected.iterations);
  EXPECT_EQ(optimization.getEnergyResult().steps.back().after, expected.steps.back().after);
  EXPECT_EQ(optimization.getKappa1(), 0.2);
  EXPECT_EQ(optimization.getEnergyOptions().iterations, 3);
  EXPECT_TRUE(told);
  optimization.setProgress([](std::string_view, double) { return false; });
  EXPECT_THROW(optimization.process(output), Cancelled);
}

TEST_F(OptimizationClass, DefaultsAreThoseOfTheMode)
{
  EXPECT_EQ(optimization.getMaximumIterations(), NormalFilteringOptions{}.iterations);
  EXPECT_EQ(optimization.getTolerance(), NormalFilteringOptions{}.tolerance);
  optimization.setMode(OptimizationMode::energy);
  EXPECT_EQ(optimization.getMaximumIterations(), EnergyOptions{}.iterations);
  EXPECT_EQ(optimization.getKappa1(), EnergyOptions{}.kappa1);
  EXPECT_EQ(optimization.getTolerance(), EnergyOptions{}.tolerance);
}

TEST(OptimizationClassInput, WithoutInputIsAnError)
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
  NormalFilteringOptions options;
  options.iterations = 3;
  options.flip = true;
  EXPECT_EQ(readMesh(folder + "/out.ply").vertices, filterSurface(mesh, points, options).mesh.vertices);
  const nlohmann::json report = nlohmann::json::parse(readFile(folder + "/report.json"));
  EXPECT_GE(report.at("steps").size(), 3U);
  EXPECT_TRUE(report.at("steps")[0].at("tangential").is_number());
  EnergyOptions energy;
  energy.iterations = 2;
  for (const std::string mode : {"energy", "faithful"}) { // the second is the old name
    EXPECT_EQ(runTool(files + " -mode " + mode + " -iterations 2 -quiet", folder), 0);
    EXPECT_EQ(readMesh(folder + "/out.ply").vertices, minimizeSurfaceEnergy(mesh, points, energy).mesh.vertices);
  }
  EXPECT_EQ(runTool(files + " -mode best -iterations 1 -quiet", folder), 0);
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
  for (const std::string wrong : {" -mode energy -flip", " -iterations 0", " -kappa1 -1", " -tolerance -1"})
    EXPECT_EQ(runTool(mesh + folder + "/points.ply " + out + wrong, folder), 2) << wrong;
  EXPECT_EQ(runTool(mesh + folder + "/points.ply", folder), 2);
  EXPECT_EQ(runTool("-h", folder), 0);
  EXPECT_FALSE(std::filesystem::exists(out));
}
} // namespace
} // namespace fresco
