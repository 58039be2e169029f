// SPDX-License-Identifier: BSD-3-Clause
#include "surface/optimization/optimization_shapes.h"
#include "test_data.h"
#include <fresco/core/pcl_conversions.h>
#include <fresco/surface/surface_optimization.h>
#include <gtest/gtest.h>
#include <pcl/point_types.h>
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
} // namespace
} // namespace fresco
