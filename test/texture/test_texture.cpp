// SPDX-License-Identifier: BSD-3-Clause
#include "test_data.h"
#include "texture/texture_scene.h"
#include <fresco/io/image_io.h>
#include <fresco/texture/core/texture_reconstruction.h>
#include <gtest/gtest.h>
namespace fresco::test {
namespace {
/// What a call's exception says; "" if it throws none.
template <typename Call>
std::string messageOf(const Call& call)
{
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(Texture, CubeShowsWhatThePhotographsShow)
{
  const TriangleMesh mesh = cube();
  const TextureResult result = reconstructTexture(mesh, photographsAround(mesh, waves));
  const ColorError error = colorError(result.model, waves);
  EXPECT_LT(error.mean, 2.0);
  EXPECT_LT(error.largest, 12.0); // one pixel changes the pattern by up to 5 levels
  EXPECT_GT(result.coverage, 0.999);
  EXPECT_GE(result.face_view.minCoeff(), 0);
  EXPECT_EQ(result.model.mesh.faces, mesh.faces);
}

TEST(Texture, CoordinatesLieInsideTheAtlas)
{
  const TriangleMesh mesh = cube();
  const TextureResult result = reconstructTexture(mesh, photographsAround(mesh, waves));
  EXPECT_GT(result.model.texcoords.minCoeff(), 0.f);
  EXPECT_LT(result.model.texcoords.maxCoeff(), 1.f);
  EXPECT_GE(result.model.texcoord_faces.minCoeff(), 0);
  EXPECT_EQ(result.model.face_atlas.size(), mesh.faceCount());
  EXPECT_EQ(result.masks.size(), result.model.atlases.size());
  EXPECT_GT(result.used, 0.5); // six squares
}

TEST(Texture, ThreadsDoNotChangeTheResult)
{
  const TriangleMesh mesh = cube();
  const auto views = photographsAround(mesh, waves);
  const TextureResult one = reconstructTexture(mesh, views, withThreads(1)),
                      four = reconstructTexture(mesh, views, withThreads(4));
  EXPECT_TRUE(sameAtlases(one, four));
  EXPECT_EQ(one.face_view, four.face_view);
}

TEST(Texture, LargeCoordinatesLoseNothing)
{
  TriangleMesh mesh = cube();
  const TextureResult here = reconstructTexture(mesh, photographsAround(mesh, waves));
  mesh.origin = {500000, 4000000, 100};
  const auto moved = [&](const Eigen::Vector3d& p) { return waves(p - mesh.origin); };
  const TextureResult there = reconstructTexture(mesh, photographsAround(mesh, moved));
  EXPECT_LT(colorError(there.model, moved).mean, colorError(here.model, waves).mean + 0.5);
}

TEST(Texture, LensDistortionIsRemoved)
{
  const TriangleMesh mesh = cube();
  CameraModel lens = camera();
  lens.k1 = -0.15;
  lens.k2 = 0.05;
  lens.p1 = 0.01;
  const TextureResult result = reconstructTexture(mesh, photographsAround(mesh, waves, 4, lens));
  EXPECT_LT(colorError(result.model, waves).mean, 2.0);
  EXPECT_GT(result.coverage, 0.999);
}

TEST(Texture, TexelSizeIsKept)
{
  const TriangleMesh mesh = cube();
  const auto views = photographsAround(mesh, waves);
  TextureOptions options;
  options.texel = 0.05;
  const TextureResult result = reconstructTexture(mesh, views, options);
  EXPECT_NEAR(result.texel, 0.05, 1e-6);
  const double least = 24 / (0.05 * 0.05); // texels on 24 units of area
  const double all = static_cast<double>(result.model.atlases.size()) * result.model.atlases[0].data.size() / 3;
  EXPECT_GT(all, least);
  EXPECT_LT(all, 3 * least);
  EXPECT_LT(colorError(result.model, waves).mean, 4.0);
}

TEST(Texture, SmallAtlasesBecomeSeveral)
{
  const TriangleMesh mesh = cube();
  TextureOptions options;
  options.atlas = 160;
  const TextureResult result = reconstructTexture(mesh, photographsAround(mesh, waves), options);
  EXPECT_GT(result.model.atlases.size(), 1u);
  for (const Image& atlas : result.model.atlases) {
    EXPECT_LE(atlas.width, 160);
    EXPECT_EQ(atlas.height, atlas.width);
  }
  EXPECT_LT(result.model.face_atlas.maxCoeff(), static_cast<int>(result.model.atlases.size()));
  options.atlas = 16384; // none is larger than it needs to be
  EXPECT_LT(reconstructTexture(mesh, photographsAround(mesh, waves), options).model.atlases.at(0).width, 2000);
  EXPECT_LT(colorError(result.model, waves).mean, 3.0);
}

TEST(Texture, AnOccluderLeavesNoGhost)
{
  TriangleMesh mesh; // a slab, and a red post before it
  appendBox({-3, -3, -0.2f}, {3, 3, 0}, false, mesh);
  const Index slab = mesh.faceCount();
  appendBox({-0.15f, -1, 0.8f}, {0.15f, 1, 1.1f}, false, mesh);
  const auto pattern = [](const Eigen::Vector3d& p) {
    return p.z() > 0.5 ? Eigen::Vector3d(255, 0, 0)
                       : Eigen::Vector3d(0, 160 + 40 * std::sin(3 * p.x()), 120 + 40 * std::sin(2 * p.y()));
  };
  std::vector<TextureView> views;
  for (const double x : {-3.0, -1.0, 1.0, 3.0})
    views.push_back(photograph(mesh, pattern, camera(320, 240, 200), lookAt({x, 0.5, 5}, {0, 0, 0})));
  const TextureResult result = reconstructTexture(mesh, views);
  double red = 0;
  forPlaces(mesh, 2000, [&](Index f, const Eigen::Vector3d& weights) {
    const Eigen::Vector3d p = pointAt(mesh, f, weights);
    if (f < slab && p.z() > -0.01 && p.cwiseAbs().head<2>().maxCoeff() < 2.5)
      red = std::max(red, colorAt(result.model, f, weights).x());
  });
  EXPECT_LT(red, 30);
}

TEST(Texture, WhatNobodySeesIsContinuedAndMarked)
{
  const TriangleMesh mesh = cube();
  std::vector<TextureView> views;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      views.push_back(photograph(mesh, waves, camera(), lookAt({2.3 * x, 2.3 * y, 2.3}, {0, 0, 0})));
  const TextureResult result = reconstructTexture(mesh, views);
  EXPECT_NEAR(result.coverage, 5.0 / 6, 0.01);
  const Index marked = std::count(result.masks[0].data.begin(), result.masks[0].data.end(), 255);
  EXPECT_GT(marked, 500);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    if (const bool bottom = (pointAt(mesh, f, Eigen::Vector3d::Constant(1.0 / 3)).z() < -0.9)) {
      EXPECT_EQ(result.face_view[f], -1);
      const Eigen::Vector3d color = colorAt(result.model, f, {0.98, 0.01, 0.01}),
                            wanted = waves(pointAt(mesh, f, {1, 0, 0}));
      EXPECT_LT((color - wanted).cwiseAbs().maxCoeff(), 40) << bottom; // continues what its border shows
    }
}

TEST(Texture, NoViewSeesTheMesh)
{
  const TriangleMesh mesh = cube();
  const TextureView away = photograph(mesh, waves, camera(), lookAt({0, 0, 5}, {0, 0, 9}));
  for (const auto& views : {std::vector<TextureView>{}, std::vector<TextureView>{away}}) {
    const TextureResult result = reconstructTexture(mesh, views);
    EXPECT_EQ(result.coverage, 0);
    EXPECT_EQ(result.views_used, 0);
    EXPECT_EQ(result.face_view.maxCoeff(), -1);
    EXPECT_EQ(colorAt(result.model, 0, {0.3, 0.3, 0.4}), Eigen::Vector3d(128, 128, 128));
  }
}

TEST(Texture, ColorsOfTheMeshFillWhatNobodySees)
{
  TriangleMesh mesh = cube();
  mesh.colors.resize(3, mesh.vertexCount());
  mesh.colors.colwise() = Eigen::Matrix<std::uint8_t, 3, 1>(10, 20, 30);
  const TextureResult result = reconstructTexture(mesh, {});
  EXPECT_EQ(colorAt(result.model, 0, {0.3, 0.3, 0.4}), Eigen::Vector3d(10, 20, 30));
}

TEST(Texture, ACameraInsideGeometryAddsNothing)
{
  const TriangleMesh mesh = cube();
  auto views = photographsAround(mesh, waves);
  const TextureResult without = reconstructTexture(mesh, views);
  TextureView inside = views.front();
  inside.T_camera_world = lookAt({0.1, 0.2, 0.3}, {1, 1, 1});
  views.push_back(inside);
  const TextureResult with = reconstructTexture(mesh, views);
  EXPECT_TRUE(sameAtlases(without, with));
}

TEST(Texture, PhotographOfAnotherSizeIsNamed)
{
  const TriangleMesh mesh = cube();
  auto views = photographsAround(mesh, waves);
  views[3].path = "corner.jpg";
  views[3].camera.width = 400;
  const std::string message = messageOf([&] { reconstructTexture(mesh, views); });
  EXPECT_NE(message.find("corner.jpg"), std::string::npos) << message;
  EXPECT_NE(message.find("200x200"), std::string::npos) << message;
  EXPECT_NE(message.find("400x200"), std::string::npos) << message;
}

TEST(Texture, MissingPhotographIsNamed)
{
  const TriangleMesh mesh = cube();
  auto views = photographsAround(mesh, waves);
  views[2].image = Image();
  views[2].path = scratchFolder() + "/absent.jpg";
  const std::string message = messageOf([&] { reconstructTexture(mesh, views); });
  EXPECT_NE(message.find("absent.jpg"), std::string::npos) << message;
}

TEST(Texture, PhotographsAreReadFromFiles)
{
  const TriangleMesh mesh = cube();
  auto views = photographsAround(mesh, waves);
  const TextureResult held = reconstructTexture(mesh, views);
  const std::string folder = scratchFolder();
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].path = folder + "/" + std::to_string(i) + ".png";
    writeImage(views[i].path, views[i].image);
    views[i].image = Image();
  }
  TextureOptions options;
  options.memory = 1; // less than all of them together
  EXPECT_TRUE(sameAtlases(held, reconstructTexture(mesh, views, options)));
}

TEST(Texture, GreyPhotographsStayGrey)
{
  const TriangleMesh mesh = cube();
  auto views = photographsAround(mesh, waves);
  for (TextureView& view : views) {
    Image grey(view.image.width, view.image.height, 1, 77);
    view.image = grey;
  }
  const TextureResult result = reconstructTexture(mesh, views);
  EXPECT_EQ(colorAt(result.model, 0, {0.3, 0.3, 0.4}), Eigen::Vector3d(77, 77, 77));
}

TEST(Texture, DegenerateFacesAreHarmless)
{
  TriangleMesh mesh = cube();
  const Index faces = mesh.faceCount();
  mesh.faces.conservativeResize(3, faces + 2);
  mesh.faces.col(faces) << 0, 0, 1;
  mesh.faces.col(faces + 1) << 2, 2, 2;
  const TextureResult result = reconstructTexture(mesh, photographsAround(mesh, waves));
  EXPECT_GT(result.coverage, 0.999);
  EXPECT_EQ(result.model.face_atlas[faces], -1);
}

TEST(Texture, BadArgumentsAreRefused)
{
  const TriangleMesh mesh = cube();
  const auto views = photographsAround(mesh, waves, 4, camera(20, 20, 26));
  const auto refuses = [&](const auto& change) {
    TextureOptions options;
    std::vector<TextureView> changed = views;
    change(options, changed[0]);
    EXPECT_THROW(reconstructTexture(mesh, changed, options), std::invalid_argument);
  };
  refuses([](TextureOptions& o, TextureView&) { o.texel = -1; });
  refuses([](TextureOptions& o, TextureView&) { o.texel = std::nan(""); });
  refuses([](TextureOptions& o, TextureView&) { o.atlas = 5; });
  refuses([](TextureOptions& o, TextureView&) { o.atlas = 100000; });
  refuses([](TextureOptions& o, TextureView&) { o.border = 0; });
  refuses([](TextureOptions& o, TextureView&) { o.smoothness = -1; });
  refuses([](TextureOptions& o, TextureView&) { o.margin = std::nan(""); });
  refuses([](TextureOptions& o, TextureView&) { o.depth_tolerance = 1; });
  refuses([](TextureOptions& o, TextureView&) { o.memory = 0; });
  refuses([](TextureOptions& o, TextureView&) { o.blend_width = -1; });
  refuses([](TextureOptions& o, TextureView&) { o.threads = -1; });
  refuses([](TextureOptions&, TextureView& v) { v.camera.fx = 0; });
  refuses([](TextureOptions&, TextureView& v) { v.camera.k1 = std::nan(""); });
  refuses([](TextureOptions&, TextureView& v) { v.T_camera_world.linear() *= 2; });
  refuses([](TextureOptions&, TextureView& v) { v.T_camera_world.translation().x() = std::nan(""); });
  refuses([](TextureOptions&, TextureView& v) { v.image = Image(); });
  EXPECT_THROW(reconstructTexture(TriangleMesh(), views), std::invalid_argument);
}

TEST(Texture, TooManyTexelsAreRefusedBeforeTheyAreMade)
{
  const TriangleMesh mesh = cube();
  TextureOptions options;
  options.texel = 1e-6;
  const std::string message = messageOf([&] { reconstructTexture(mesh, photographsAround(mesh, waves), options); });
  EXPECT_NE(message.find("megatexels"), std::string::npos) << message;
}

TEST(Texture, StopsWhenAsked)
{
  const TriangleMesh mesh = cube();
  const auto views = photographsAround(mesh, waves, 4, camera(20, 20, 26));
  EXPECT_THROW(reconstructTexture(mesh, views, {}, [](std::string_view, double done) { return done < 0.3; }),
               Cancelled);
}
} // namespace
} // namespace fresco::test
