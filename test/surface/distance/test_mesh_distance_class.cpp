// SPDX-License-Identifier: BSD-3-Clause
#include "surface/distance/distance_meshes.h"
#include <fresco/core/pcl_conversions.h>
#include <fresco/surface/mesh_distance.h>
#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>
namespace fresco {
namespace {
pcl::PolygonMesh::Ptr polygonMesh(const TriangleMesh& mesh)
{
  const auto polygons = pcl::make_shared<pcl::PolygonMesh>();
  toPolygonMesh(mesh, *polygons);
  return polygons;
}

TEST(MeshDistanceClass, EqualsCoreAndColorsTheMesh)
{
  const TriangleMesh mesh = test::roundedCube(8, 0.3f), reference = test::gridCube(8);
  MeshDistance distance;
  distance.setInputMesh(polygonMesh(mesh));
  distance.setReferenceMesh(polygonMesh(reference));
  distance.setNumberOfSamples(1000);
  distance.setSeed(5);
  distance.setNumberOfThreads(1);
  pcl::PolygonMesh output;
  distance.process(output);

  MeshDistanceOptions options;
  options.samples = distance.getNumberOfSamples();
  options.seed = distance.getSeed();
  const MeshDistanceResult expected = measureMeshDistance(mesh, reference, options);
  EXPECT_EQ(distance.getResult().vertices.symmetric.rms, expected.vertices.symmetric.rms);
  EXPECT_EQ(distance.getResult().surface.symmetric.mean, expected.surface.symmetric.mean);
  EXPECT_EQ(distance.getResult().vertex_distances, expected.vertex_distances);

  const TriangleMesh colored = toTriangleMesh(output);
  EXPECT_EQ(colored.faces, mesh.faces);
  EXPECT_EQ(colored.fields.at("distance"), expected.vertex_distances);
  Index farthest;
  expected.vertex_distances.maxCoeff(&farthest);
  EXPECT_EQ(int(colored.colors(2, farthest)), 255); // blue
  pcl::PointCloud<pcl::PointXYZRGB> cloud;
  pcl::fromPCLPointCloud2(output.cloud, cloud); // PCL reads the colours
  EXPECT_EQ(int(cloud[farthest].b), 255);
}

TEST(MeshDistanceClass, HasTheSettersOfTheOtherClasses)
{
  MeshDistance distance;
  MeshDistanceOptions options;
  options.samples = 7;
  distance.setOptions(options);
  EXPECT_EQ(distance.getNumberOfSamples(), 7);
  distance.setNumberOfSamples(8);
  EXPECT_EQ(distance.getOptions().samples, 8);
  distance.setThreads(2);
  EXPECT_EQ(distance.getNumberOfThreads(), 2);
  distance.setInputMesh(polygonMesh(test::gridCube(2)));
  distance.setReferenceMesh(polygonMesh(test::gridCube(2)));
  distance.setProgress([](std::string_view, double) { return false; });
  EXPECT_THROW(distance.compute(), Cancelled);
}

TEST(MeshDistanceClass, PolygonsAreTriangulated)
{
  const TriangleMesh square = test::gridPlane(2.f, 2.f, 1);
  auto quad = polygonMesh(square);
  quad->polygons.assign(1, pcl::Vertices());
  quad->polygons[0].vertices = {0, 1, 3, 2};
  MeshDistance distance;
  distance.setInputMesh(polygonMesh(test::moved(square, Eigen::Isometry3f(Eigen::Translation3f(0, 0, 2)))));
  distance.setReferenceMesh(quad);
  EXPECT_NEAR(distance.compute().vertices.symmetric.max, 2.0, 1e-6);
  EXPECT_NEAR(distance.getResult().normals_to_reference.percentile95, 0.0, 1e-6);
}

TEST(MeshDistanceClass, OutputMayBeTheInput)
{
  const auto mesh = polygonMesh(test::roundedCube(4, 0.3f));
  const std::size_t faces = mesh->polygons.size();
  MeshDistance distance;
  distance.setInputMesh(mesh);
  distance.setReferenceMesh(polygonMesh(test::gridCube(4)));
  distance.process(*mesh);
  EXPECT_EQ(mesh->polygons.size(), faces);
}

TEST(MeshDistanceClass, MissingMeshesAreErrors)
{
  MeshDistance distance;
  pcl::PolygonMesh output;
  EXPECT_THROW(distance.process(output), std::invalid_argument);
  EXPECT_THROW(distance.compute(), std::invalid_argument);
  distance.setInputMesh(polygonMesh(test::gridCube(2)));
  EXPECT_THROW(distance.process(output), std::invalid_argument);
  distance.setReferenceMesh(pcl::make_shared<pcl::PolygonMesh>());
  EXPECT_THROW(distance.process(output), std::invalid_argument);
}
} // namespace
} // namespace fresco
