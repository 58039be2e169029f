// SPDX-License-Identifier: BSD-3-Clause
#include "test_data.h"
#include "texture/texture_scene.h"
#include <fresco/texture/texture_reconstruction.h>
#include <pcl/io/obj_io.h>
namespace fresco::test {
namespace {
pcl::PolygonMesh::Ptr polygons(const TriangleMesh& mesh)
{
  auto out = pcl::make_shared<pcl::PolygonMesh>();
  toPolygonMesh(mesh, *out);
  out->header.frame_id = "room";
  return out;
}

TEST(TextureReconstruction, IsTheCoreInPclTypes)
{
  const TriangleMesh mesh = cube();
  const auto views = photographsAround(mesh, waves);
  TextureReconstruction texture;
  texture.setInputMesh(polygons(mesh));
  for (const TextureView& view : views)
    texture.addView(view);
  pcl::TextureMesh out;
  texture.process(out);
  const TextureResult core = reconstructTexture(mesh, views);
  EXPECT_EQ(out.header.frame_id, "room");
  ASSERT_EQ(out.tex_polygons.size(), core.model.atlases.size());
  EXPECT_EQ(out.tex_polygons[0].size(), static_cast<std::size_t>(mesh.faceCount()));
  EXPECT_EQ(texture.getResult().model.atlases[0].data, core.model.atlases[0].data);
}

TEST(TextureReconstruction, KeepsAGivenLayout)
{
  const TriangleMesh mesh = cube();
  TextureReconstruction texture;
  texture.setInputMesh(polygons(mesh));
  for (const TextureView& view : photographsAround(mesh, waves))
    texture.addView(view);
  auto first = pcl::make_shared<pcl::TextureMesh>();
  texture.process(*first);
  texture.setInputMesh(first);
  EXPECT_EQ(texture.getInputMesh(), nullptr);
  EXPECT_EQ(texture.getInputLayout(), first);
  texture.setAtlasSize(200);
  pcl::TextureMesh second;
  texture.process(second);
  EXPECT_EQ(second.header.frame_id, "room");
  ASSERT_EQ(second.tex_coordinates.size(), first->tex_coordinates.size());
  for (std::size_t part = 0; part < second.tex_coordinates.size(); ++part)
    EXPECT_EQ(second.tex_coordinates[part], first->tex_coordinates[part]);
  const Image& atlas = texture.getResult().model.atlases[0];
  EXPECT_EQ(std::max(atlas.width, atlas.height), 200);

  texture.setInputMesh(polygons(mesh)); // a layout is made again
  EXPECT_EQ(texture.getInputLayout(), nullptr);
  texture.process(second);
  EXPECT_EQ(texture.getResult().model.mesh.faceCount(), mesh.faceCount());

  first->tex_coordinates[0].pop_back();
  texture.setInputMesh(first);
  EXPECT_THROW(texture.process(second), std::invalid_argument);
}

TEST(TextureReconstruction, PclWritesIt)
{
  const TriangleMesh mesh = cube();
  TextureReconstruction texture;
  texture.setInputMesh(polygons(mesh));
  for (const TextureView& view : photographsAround(mesh, waves))
    texture.addView(view);
  pcl::TextureMesh out;
  texture.process(out);
  const std::string folder = scratchFolder();
  texture.saveAtlases(folder);
  ASSERT_EQ(pcl::io::saveOBJFile(folder + "/cube.obj", out, 9), 0);
  EXPECT_TRUE(std::filesystem::exists(folder + "/" + out.tex_materials[0].tex_file));
}

TEST(TextureReconstruction, SettersReachTheOptions)
{
  const TextureOptions defaults;
  TextureReconstruction texture;
  EXPECT_EQ(texture.getBorder(), defaults.border);
  EXPECT_EQ(texture.getMemory(), defaults.memory);
  texture.setTexelSize(0.01);
  texture.setAtlasSize(1024);
  texture.setBorder(3);
  texture.setSmoothness(0.5);
  texture.setMargin(7);
  texture.setDepthTolerance(0.02);
  texture.setBackProjectionRounds(2);
  texture.setMemory(64);
  texture.setNumberOfThreads(2);
  EXPECT_EQ(texture.getTexelSize(), 0.01);
  EXPECT_EQ(texture.getAtlasSize(), 1024);
  EXPECT_EQ(texture.getBorder(), 3);
  EXPECT_EQ(texture.getSmoothness(), 0.5);
  EXPECT_EQ(texture.getMargin(), 7);
  EXPECT_EQ(texture.getDepthTolerance(), 0.02);
  EXPECT_EQ(texture.getBackProjectionRounds(), 2);
  EXPECT_EQ(texture.getMemory(), 64);
  EXPECT_EQ(texture.getNumberOfThreads(), 2);
  texture.setBlendStrip(4); // the old name
  EXPECT_EQ(texture.getBlendWidth(), 4);
  texture.setOptions(TextureOptions());
  EXPECT_EQ(texture.getOptions().border, defaults.border);
}

TEST(TextureReconstruction, WithoutMeshItSaysSo)
{
  TextureReconstruction texture;
  pcl::TextureMesh out;
  EXPECT_THROW(texture.process(out), std::invalid_argument);
}
} // namespace
} // namespace fresco::test
