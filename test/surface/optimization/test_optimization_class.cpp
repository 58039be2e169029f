// SPDX-License-Identifier: BSD-3-Clause
#include "surface/optimization/optimization_shapes.h"
#include "test_data.h"
#include <fresco/core/pcl_conversions.h>
#include <fresco/surface/surface_optimization.h>
#include <gtest/gtest.h>
#include <pcl/point_types.h>
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
  EXPECT_EQ(optimization.getResult().flipped_edges, expected.flipped_edges);
  EXPECT_EQ(optimization.getOptions().smoothness_weight, 0.5);
}

TEST_F(OptimizationClass, TellsItsProgressAndStops)
{
  NormalFilteringOptions options;
  options.iterations = 3;
  options.smoothness_weight = 0.2;
  optimization.setOptions(options);
  bool told = false;
  optimization.setProgress([&](std::string_view, double) { return told = true; });
  optimization.process(output);
  EXPECT_TRUE(told);
  EXPECT_EQ(optimization.getKappa1(), 0.2);
  EXPECT_EQ(optimization.getResult().steps.back().after, filterSurface(mesh, points, options).steps.back().after);
  optimization.setProgress([](std::string_view, double) { return false; });
  EXPECT_THROW(optimization.process(output), Cancelled);
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
} // namespace
} // namespace fresco
