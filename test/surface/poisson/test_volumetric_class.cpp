// SPDX-License-Identifier: BSD-3-Clause
#include "surface/poisson/volumetric_shapes.h"
#include <fresco/core/pcl_conversions.h>
#include <fresco/surface/volumetric_reconstruction.h>
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
namespace fresco::test {
namespace {
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr cloudOf(const PointSet& set)
{
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
  toPointCloud(set, *cloud);
  cloud->header.frame_id = "room";
  return cloud;
}

TEST(VolumetricClass, GivesWhatTheCoreGives)
{
  const PointSet points = sphere(5000);
  VolumetricReconstruction<pcl::PointNormal> poisson;
  poisson.setInputCloud(cloudOf<pcl::PointNormal>(points));
  poisson.setDepth(5);
  pcl::PolygonMesh mesh;
  poisson.reconstruct(mesh);
  const TriangleMesh expected = reconstructVolumetric(points, atDepth(5)).mesh, got = toTriangleMesh(mesh);
  EXPECT_EQ(got.vertices, expected.vertices);
  EXPECT_EQ(got.faces, expected.faces);
  EXPECT_EQ(got.fields.count("support"), 1u);
  EXPECT_EQ(mesh.header.frame_id, "room");
  EXPECT_EQ(mesh.cloud.header.frame_id, "room");
  EXPECT_EQ(poisson.getResult().used_points, 5000);
  EXPECT_GT(poisson.estimateMemory(), 100000u);
}

TEST(VolumetricClass, PointsOverloadHasNormals)
{
  VolumetricReconstruction<pcl::PointNormal> poisson;
  poisson.setInputCloud(cloudOf<pcl::PointNormal>(sphere(5000)));
  poisson.setDepth(5);
  pcl::PointCloud<pcl::PointNormal> vertices;
  std::vector<pcl::Vertices> polygons;
  poisson.reconstruct(vertices, polygons);
  ASSERT_FALSE(polygons.empty());
  for (const pcl::PointNormal& p : vertices)
    EXPECT_GT(p.getNormalVector3fMap().dot(p.getVector3fMap().normalized()), 0.9f);
  for (const pcl::Vertices& polygon : polygons)
    for (const auto v : polygon.vertices)
      ASSERT_LT(static_cast<std::size_t>(v), vertices.size());
}

TEST(VolumetricClass, HonoursIndices)
{
  const PointSet points = sphere(20000);
  auto indices = pcl::make_shared<pcl::Indices>();
  for (int i = 0; i < 20000; ++i)
    if (points.points(2, i) > 0)
      indices->push_back(i);
  VolumetricReconstruction<pcl::PointNormal> poisson;
  poisson.setInputCloud(cloudOf<pcl::PointNormal>(points));
  poisson.setIndices(indices);
  poisson.setDepth(6);
  poisson.setTrim(4.f);
  pcl::PolygonMesh mesh;
  poisson.reconstruct(mesh);
  EXPECT_EQ(poisson.getResult().used_points, static_cast<Index>(indices->size()));
  EXPECT_GT(toTriangleMesh(mesh).vertices.row(2).minCoeff(), -0.3f);
  indices->push_back(20000);
  poisson.setIndices(indices);
  EXPECT_THROW(poisson.reconstruct(mesh), std::invalid_argument);
}

TEST(VolumetricClass, CarriesColorsAndIntensities)
{
  PointSet points = sphere(5000);
  points.colors = Colors::Constant(3, 5000, 77);
  VolumetricReconstruction<pcl::PointXYZRGBNormal> with_color;
  with_color.setInputCloud(cloudOf<pcl::PointXYZRGBNormal>(points));
  with_color.setDepth(5);
  pcl::PolygonMesh mesh;
  with_color.reconstruct(mesh);
  const TriangleMesh colored = toTriangleMesh(mesh);
  ASSERT_EQ(colored.colors.cols(), colored.vertexCount());
  EXPECT_TRUE((colored.colors.array() == 77).all());
  points.intensities = Eigen::VectorXf::Constant(5000, 3.f);
  VolumetricReconstruction<pcl::PointXYZINormal> with_intensity;
  with_intensity.setInputCloud(cloudOf<pcl::PointXYZINormal>(points));
  with_intensity.setDepth(5);
  pcl::PointCloud<pcl::PointXYZINormal> vertices;
  std::vector<pcl::Vertices> polygons;
  with_intensity.reconstruct(vertices, polygons);
  for (const auto& p : vertices)
    EXPECT_NEAR(p.intensity, 3.f, 1e-4f);
}

TEST(VolumetricClass, HasEverySetterOfPclPoisson)
{
  VolumetricReconstruction<pcl::PointNormal> poisson;
  EXPECT_EQ(poisson.getDepth(), 8);
  EXPECT_EQ(poisson.getMinDepth(), 5);
  EXPECT_EQ(poisson.getPointWeight(), 4.f);
  EXPECT_EQ(poisson.getScale(), 1.1f);
  poisson.setDepth(6);
  poisson.setMinDepth(4);
  poisson.setPointWeight(2.f);
  poisson.setScale(1.2f);
  poisson.setSolverDivide(7);
  poisson.setIsoDivide(7);
  poisson.setSamplesPerNode(2.f);
  poisson.setConfidence(true);
  poisson.setOutputPolygons(true);
  poisson.setDegree(1);
  poisson.setManifold(false);
  poisson.setThreads(2);
  EXPECT_EQ(poisson.getDepth(), 6);
  EXPECT_EQ(poisson.getMinDepth(), 4);
  EXPECT_EQ(poisson.getPointWeight(), 2.f);
  EXPECT_EQ(poisson.getScale(), 1.2f);
  EXPECT_EQ(poisson.getSolverDivide(), 7);
  EXPECT_EQ(poisson.getIsoDivide(), 7);
  EXPECT_EQ(poisson.getSamplesPerNode(), 2.f);
  EXPECT_TRUE(poisson.getConfidence());
  EXPECT_TRUE(poisson.getOutputPolygons());
  EXPECT_EQ(poisson.getDegree(), 1);
  EXPECT_FALSE(poisson.getManifold());
  EXPECT_EQ(poisson.getThreads(), 2);
}

TEST(VolumetricClass, HasTheSettersOfTheOtherClasses)
{
  VolumetricReconstruction<pcl::PointNormal> poisson;
  poisson.setNumberOfThreads(3);
  poisson.setMaximumIterations(9);
  EXPECT_EQ(poisson.getThreads(), 3);
  EXPECT_EQ(poisson.getNumberOfThreads(), 3);
  EXPECT_EQ(poisson.getMaximumIterations(), 9);
  EXPECT_EQ(poisson.getOptions().iterations, 9);
  poisson.setOptions(atDepth(5));
  EXPECT_EQ(poisson.getDepth(), 5);
}

TEST(VolumetricClass, NeedsNoSearchMethod)
{
  VolumetricReconstruction<pcl::PointNormal> poisson;
  poisson.setInputCloud(cloudOf<pcl::PointNormal>(sphere(5000)));
  poisson.setDepth(5);
  pcl::PolygonMesh without, with;
  poisson.reconstruct(without);
  poisson.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointNormal>>());
  poisson.reconstruct(with);
  EXPECT_EQ(with.cloud.data, without.cloud.data);
}

TEST(VolumetricClass, SaysWhatIsWrong)
{
  VolumetricReconstruction<pcl::PointNormal> poisson;
  pcl::PolygonMesh mesh;
  EXPECT_THROW(poisson.reconstruct(mesh), std::invalid_argument);
  poisson.setInputCloud(pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>());
  EXPECT_THROW(poisson.reconstruct(mesh), std::invalid_argument);
  poisson.setInputCloud(cloudOf<pcl::PointNormal>(sphere(2000)));
  poisson.setProgress([](std::string_view, double) { return false; });
  EXPECT_THROW(poisson.reconstruct(mesh), Cancelled);
}
} // namespace
} // namespace fresco::test
