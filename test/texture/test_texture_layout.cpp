// SPDX-License-Identifier: BSD-3-Clause
#include "texture/texture_scene.h"
#include <gtest/gtest.h>
namespace fresco::test {
namespace {
/// Each face of the cube in a cell of its own of a picture of 640x480 texels; every other one mirrored.
TexturedMesh inCells()
{
  TexturedMesh model;
  model.mesh = cube();
  model.atlases.emplace_back(640, 480);
  const Index faces = model.mesh.faceCount();
  model.texcoords.resize(2, 3 * faces);
  model.texcoord_faces.resize(3, faces);
  model.face_atlas.setZero(faces);
  for (Index f = 0; f < faces; ++f) {
    const Eigen::Vector2f low(0.25 * (f % 4) + 0.01, (f / 4) / 3.0 + 0.01);
    const bool mirrored = f % 2 == 1;
    model.texcoords.col(3 * f) = low;
    model.texcoords.col(3 * f + 1) = low + (mirrored ? Eigen::Vector2f(0, 0.3) : Eigen::Vector2f(0.22, 0));
    model.texcoords.col(3 * f + 2) = low + (mirrored ? Eigen::Vector2f(0.22, 0) : Eigen::Vector2f(0, 0.3));
    model.texcoord_faces.col(f) << 3 * f, 3 * f + 1, 3 * f + 2;
  }
  return model;
}

TEST(TextureLayout, CoordinatesThatWereGivenStayAndShowThePhotographs)
{
  const TexturedMesh model = inCells();
  const auto views = photographsAround(model.mesh, waves);
  const TextureResult result = reconstructTexture(model, views);
  EXPECT_EQ(result.model.texcoords, model.texcoords);
  EXPECT_EQ(result.model.texcoord_faces, model.texcoord_faces);
  ASSERT_EQ(result.model.atlases.size(), 1U);
  EXPECT_EQ(result.model.atlases[0].width, 640);
  EXPECT_EQ(result.model.atlases[0].height, 480);
  EXPECT_LT(colorError(result.model, waves).mean, 2.0);
  EXPECT_GT(result.coverage, 0.999);
  EXPECT_TRUE(sameAtlases(result, reconstructTexture(model, views, withThreads(1))));
}

TEST(TextureLayout, WhatIsMadeIsKeptWhenMadeAgain)
{
  const TriangleMesh mesh = cube();
  const auto views = photographsAround(mesh, waves);
  const TextureResult first = reconstructTexture(mesh, views), again = reconstructTexture(first.model, views);
  EXPECT_EQ(again.model.texcoords, first.model.texcoords);
  EXPECT_EQ(again.charts, first.charts);
  EXPECT_LT(colorError(again.model, waves).mean, colorError(first.model, waves).mean + 0.2);
}

TEST(TextureLayout, AtlasesWithoutSizeGetOne)
{
  TexturedMesh model = inCells();
  const auto views = photographsAround(model.mesh, waves);
  model.atlases[0] = Image();
  const TextureResult result = reconstructTexture(model, views);
  EXPECT_GE(result.model.atlases[0].width, 400); // a side of the cube is 170 pixels wide
  EXPECT_LT(colorError(result.model, waves).mean, 2.0);
  TextureOptions options;
  options.atlas = 1000;
  EXPECT_EQ(reconstructTexture(model, views, options).model.atlases[0].width, 1000);
}

TEST(TextureLayout, LayoutsThatCannotBePaintedAreRefused)
{
  const TexturedMesh good = inCells();
  const auto views = photographsAround(good.mesh, waves);
  const auto refuses = [&](const TexturedMesh& model) {
    EXPECT_THROW(reconstructTexture(model, views), std::invalid_argument);
  };
  TexturedMesh model = good;
  model.texcoord_faces.col(5) = model.texcoord_faces.col(4); // overlap
  refuses(model);
  model = good;
  model.texcoord_faces.col(5).setConstant(-1);
  model.face_atlas[5] = -1;
  refuses(model);
  model = good;
  model.texcoords(0, 7) = 1.5f;
  refuses(model);
  model.texcoords(0, 7) = NAN;
  refuses(model);
  TextureOptions options;
  options.texel = 0.1;
  EXPECT_THROW(reconstructTexture(good, views, options), std::invalid_argument);
}
} // namespace
} // namespace fresco::test
