// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/test_io_data.h"
#include <fresco/core/pcl_conversions.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/texture_mesh_conversions.h>
#include <pcl/conversions.h>
#include <pcl/io/obj_io.h>
#include <pcl/point_types.h>
namespace {
using namespace fresco;
using test::fullPointSet;
using test::sameValues;

template <typename PointT>
class PclConversions : public testing::Test {};
using PointTypes = testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointXYZRGBA, pcl::PointNormal,
                                  pcl::PointXYZRGBNormal, pcl::PointXYZINormal, pcl::PointWithViewpoint,
                                  pcl::PointSurfel, pcl::InterestPoint>;
TYPED_TEST_SUITE(PclConversions, PointTypes);

TYPED_TEST(PclConversions, KeepWhatThePointTypeHas)
{
  namespace fields = pcl::fields;
  using pcl::traits::has_field;
  const PointSet set = fullPointSet(40);
  pcl::PointCloud<TypeParam> cloud;
  cloud.header.frame_id = "scanner";
  toPointCloud(set, cloud);
  EXPECT_EQ(cloud.header.frame_id, "scanner");
  EXPECT_EQ(cloud.width, 40U);
  EXPECT_FALSE(cloud.is_dense);
  const PointSet back = toPointSet(cloud);
  EXPECT_TRUE(sameValues(back.points, set.points));
  if (has_field<TypeParam, fields::normal_x>::value)
    EXPECT_TRUE(sameValues(back.normals, set.normals));
  else
    EXPECT_EQ(back.normals.cols(), 0);
  if (has_field<TypeParam, fields::rgb>::value || has_field<TypeParam, fields::rgba>::value)
    EXPECT_EQ(back.colors, set.colors);
  else
    EXPECT_EQ(back.colors.cols(), 0);
  if (has_field<TypeParam, fields::intensity>::value)
    EXPECT_TRUE(sameValues(back.intensities, set.intensities));
  else
    EXPECT_EQ(back.intensities.size(), 0);
  if (has_field<TypeParam, fields::vp_x>::value)
    EXPECT_TRUE(sameValues(back.viewpoints, set.viewpoints));
  else
    EXPECT_EQ(back.viewpoints, Points(Eigen::Vector3f::Zero()));
}

TEST(PclConversionsOf, IndicesAndViewpoint)
{
  PointSet set = fullPointSet(10);
  set.viewpoints.resize(3, 1);
  set.viewpoints << 1, 2, 3;
  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud;
  toPointCloud(set, cloud);
  EXPECT_EQ(cloud.sensor_origin_, Eigen::Vector4f(1, 2, 3, 0));
  EXPECT_EQ(cloud[2].r, set.colors(0, 2));
  EXPECT_EQ(cloud[2].a, 255);
  const PointSet some = toPointSet(cloud, {7, 5, 7});
  ASSERT_EQ(some.size(), 3);
  EXPECT_EQ(some.points.col(2), set.points.col(7));
  EXPECT_TRUE(std::isnan(some.points(0, 1)));
  EXPECT_EQ(some.colors.col(1), set.colors.col(5));
  EXPECT_EQ(some.viewpoints, set.viewpoints);
  EXPECT_THROW(toPointSet(cloud, {10}), std::invalid_argument);
  EXPECT_THROW(toPointSet(cloud, {-1}), std::invalid_argument);
  EXPECT_EQ(toPointSet(pcl::PointCloud<pcl::PointXYZ>()).size(), 0);
}

TEST(PclConversionsOf, OriginIsAdded)
{
  PointSet set;
  set.points = test::randomPoints(5, 1);
  set.origin = Eigen::Vector3d(1000, 2000, 3000);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  toPointCloud(set, cloud);
  EXPECT_TRUE(cloud.is_dense);
  EXPECT_NEAR(cloud[3].y, 2000 + static_cast<double>(set.points(1, 3)), 2e-4);
}

TEST(PclConversionsOf, PolygonMesh)
{
  const TriangleMesh mesh = test::fullMesh(6);
  pcl::PolygonMesh polygons;
  toPolygonMesh(mesh, polygons);
  pcl::PointCloud<pcl::PointXYZRGBNormal> vertices;
  pcl::fromPCLPointCloud2(polygons.cloud, vertices);
  EXPECT_EQ(vertices[8].getVector3fMap(), mesh.vertices.col(8));
  EXPECT_EQ(vertices[8].getNormalVector3fMap(), mesh.normals.col(8));
  EXPECT_EQ(vertices[8].g, mesh.colors(1, 8));
  EXPECT_EQ(vertices[8].curvature, mesh.fields.at("curvature")[8]);
  const TriangleMesh back = toTriangleMesh(polygons);
  EXPECT_TRUE(sameValues(back.vertices, mesh.vertices));
  EXPECT_TRUE(sameValues(back.normals, mesh.normals));
  EXPECT_EQ(back.colors, mesh.colors);
  EXPECT_EQ(back.faces, mesh.faces);
  EXPECT_EQ(back.fields.size(), 2U);
  polygons.polygons[0].vertices = {0, 1, 7, 6};
  EXPECT_EQ(toTriangleMesh(polygons).faceCount(), mesh.faceCount() + 1);
  polygons.polygons[0].vertices = {0, 1, 36};
  EXPECT_THROW(toTriangleMesh(polygons), std::invalid_argument);
  EXPECT_THROW(toTriangleMesh(pcl::PolygonMesh()), std::invalid_argument);
}

TEST(PclConversionsOf, TextureMesh)
{
  const TexturedMesh model = test::fullTexturedMesh(6, 2);
  pcl::TextureMesh texture;
  toTextureMesh(model, texture, {"a.png", "b.png"});
  ASSERT_EQ(texture.tex_polygons.size(), 3U);
  EXPECT_EQ(texture.tex_polygons[2].size(), 2U);
  EXPECT_EQ(texture.tex_materials[1].tex_file, "b.png");
  const auto expectSame = [&](const TexturedMesh& back) {
    ASSERT_EQ(back.mesh.faces, model.mesh.faces);
    EXPECT_EQ(back.face_atlas, model.face_atlas);
    for (Index i = 0; i < model.mesh.faces.size(); ++i) {
      const int a = model.texcoord_faces.data()[i], b = back.texcoord_faces.data()[i];
      ASSERT_EQ(a < 0, b < 0);
      EXPECT_TRUE(a < 0 || model.texcoords.col(a) == back.texcoords.col(b));
    }
  };
  std::vector<Image> atlases = model.atlases;
  atlases.emplace_back();
  const TexturedMesh back = toTexturedMesh(texture, "", atlases);
  expectSame(back);
  EXPECT_EQ(back.atlases.size(), 2U);
  texture.tex_coord_indices.clear(); // as pcl::TextureMapping leaves it
  expectSame(toTexturedMesh(texture, "", atlases));
  texture.tex_coordinates[1].pop_back();
  EXPECT_THROW(toTexturedMesh(texture, "", atlases), std::invalid_argument);
}

TEST(PclConversionsOf, PclSavesTheTextureMesh)
{
  const std::string folder = test::scratchFolder();
  TexturedMesh model = test::fullTexturedMesh(6, 2);
  model.mesh.normals.resize(3, 0);
  for (int i = 0; i < 2; ++i)
    writeImage(folder + "/texture_" + std::to_string(i) + ".png", model.atlases[i]);
  pcl::TextureMesh texture;
  toTextureMesh(model, texture);
  ASSERT_EQ(pcl::io::saveOBJFile(folder + "/model.obj", texture, 9), 0);
  const TexturedMesh back = readTexturedMesh(folder + "/model.obj");
  EXPECT_EQ(back.mesh.faces, model.mesh.faces);
  EXPECT_EQ(back.face_atlas, model.face_atlas);
  EXPECT_EQ(back.mesh.normals.cols(), model.mesh.vertexCount());
  EXPECT_LT((back.mesh.vertices - model.mesh.vertices).cwiseAbs().maxCoeff(), 1e-6f);
  ASSERT_EQ(back.atlases.size(), 2U);
  EXPECT_EQ(back.atlases[1].data, model.atlases[1].data);
  const TexturedMesh read = toTexturedMesh(texture, folder);
  ASSERT_EQ(read.atlases.size(), 2U);
  EXPECT_EQ(read.atlases[0].data, model.atlases[0].data);
}
} // namespace
