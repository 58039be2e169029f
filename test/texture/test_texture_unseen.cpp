// SPDX-License-Identifier: BSD-3-Clause
#include "painting/color_growth.h"
#include "photographs/input_checks.h"
#include "test_data.h"
#include "texture/texture_scene.h"
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
using namespace fresco::texture;
namespace fresco::test {
namespace {
TEST(TextureUnseen, ColoursStayOnTheirSideOfACrease)
{
  // A floor and a wall, and a chest that hides where they meet.
  TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << 0, 0, 2, 2, 0, 0, -1, 1, -1, 1, -1, 1, 0, 0, 0, 0, 2, 2;
  mesh.faces.resize(3, 4);
  mesh.faces << 0, 3, 0, 5, 2, 1, 1, 4, 3, 0, 5, 0;
  const Index corner_faces = mesh.faceCount();
  appendBox({0.05f, -0.8f, 0.05f}, {0.6f, 0.8f, 0.6f}, false, mesh);
  const Eigen::Vector3d floor(60, 90, 200), wall(220, 200, 60), chest(150, 40, 40);
  const auto paint = [&](const Eigen::Vector3d& p) { return p.z() < 1e-4 ? floor : p.x() < 1e-4 ? wall : chest; };
  std::vector<TextureView> views;
  for (const double y : {-0.5, 0.5})
    views.push_back(photograph(mesh, paint, camera(320, 320, 300), lookAt({2.2, y, 1.8}, {0.3, 0, 0.3})));
  TextureOptions options = withThreads(2);
  options.refine = false;
  const TextureResult result = reconstructTexture(mesh, views, options);
  Index hidden = 0;
  forPlaces(mesh, 2000, [&](Index f, const Eigen::Vector3d& weights) {
    const Eigen::Vector3d p = pointAt(mesh, f, weights);
    const double off = p.x() + p.z(); // from the crease; on it, reading the atlas mixes its sides
    if (f >= corner_faces || std::abs(p.y()) > 0.6 || off > 0.4 || off < 0.02)
      return;
    ++hidden;
    const Eigen::Vector3d difference = colorAt(result.model, f, weights) - (f < 2 ? floor : wall);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 8) << p.transpose();
  });
  EXPECT_GT(hidden, 100);
}

TEST(TextureUnseen, GapsTakeTheColourOfTheChartsBesideThem)
{
  Chart chart;
  chart.width = chart.height = 4;
  chart.texels = OwnedTexels::from(std::vector<int>(16, 0), 4);
  chart.atlas = 0;
  chart.x = chart.y = 10;
  std::vector<Image> atlases{Image(40, 40, 3, 128)};
  for (int y = 10; y < 14; ++y)
    for (int x = 10; x < 14; ++x)
      for (int c = 0; c < 3; ++c)
        atlases[0].pixel(x, y)[c] = static_cast<std::uint8_t>(50 * c);
  fillGaps({chart}, 1, atlases);
  for (const int away : {1, 4, 8})
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(atlases[0].pixel(13 + away, 12)[c], 50 * c) << away;
  EXPECT_EQ(atlases[0].pixel(13 + 9, 12)[0], 128);
}

/// A JPEG file with an EXIF block that says how to turn it.
std::string jpegTurned(const std::string& path, int orientation, bool low_first)
{
  const std::vector<std::uint8_t> plain = encodeImage(Image(32, 24, 3, 90), ".jpg");
  const auto number = [&](int value, int length) {
    std::string out;
    for (int i = 0; i < length; ++i)
      out += static_cast<char>(value >> 8 * (low_first ? i : length - 1 - i) & 255);
    return out;
  };
  const std::string exif = std::string("Exif\0\0", 6) + (low_first ? "II" : "MM") + number(42, 2) + number(8, 4) +
                           number(1, 2) + number(274, 2) + number(3, 2) + number(1, 4) + number(orientation, 2) +
                           number(0, 2) + number(0, 4);
  const std::size_t length = exif.size() + 2;
  std::string file(plain.begin(), plain.begin() + 2);
  file += std::string("\xFF\xE1") + static_cast<char>(length >> 8) + static_cast<char>(length & 255) + exif;
  file.append(plain.begin() + 2, plain.end());
  writeFile(path, file);
  return path;
}

TEST(TextureUnseen, ExifRotationIsFound)
{
  const std::string folder = scratchFolder();
  EXPECT_EQ(exifOrientation(jpegTurned(folder + "/low.jpg", 6, true)), 6);
  EXPECT_EQ(exifOrientation(jpegTurned(folder + "/high.jpg", 8, false)), 8);
  EXPECT_EQ(exifOrientation(jpegTurned(folder + "/wild.jpg", 77, false)), 1);
  writeImage(folder + "/plain.jpg", Image(32, 24));
  EXPECT_EQ(exifOrientation(folder + "/plain.jpg"), 1);
  writeImage(folder + "/plain.png", Image(32, 24));
  EXPECT_EQ(exifOrientation(folder + "/plain.png"), 1);
  writeFile(folder + "/cut.jpg", readFile(folder + "/low.jpg").substr(0, 30));
  EXPECT_EQ(exifOrientation(folder + "/cut.jpg"), 1);
  EXPECT_EQ(exifOrientation(folder + "/absent.jpg"), 1);
}

TEST(TextureUnseen, WhatIsIgnoredIsSaid)
{
  const std::string folder = scratchFolder();
  TextureView view;
  view.camera = camera(32, 24, 40);
  view.T_camera_world = lookAt({0, 0, 5}, {0, 0, 0});
  view.path = jpegTurned(folder + "/turned.jpg", 3, true);
  const TextureResult one = reconstructTexture(cube(), {view});
  ASSERT_EQ(one.warnings.size(), 2U);
  EXPECT_NE(one.warnings[0].find("turned.jpg carries an EXIF rotation"), std::string::npos);
  view.image = readImage(view.path);
  const std::vector<std::string> without = reconstructTexture(cube(), {view}).warnings;
  ASSERT_EQ(without.size(), 1U); // one side of six
  EXPECT_NE(without[0].find("of the surface is seen"), std::string::npos);
  const std::vector<TextureView> many(401, view); // as many as one likes are refined
  EXPECT_EQ(reconstructTexture(cube(), many).warnings, without);
}

/// A red square in the middle of the second of two views that see the top.
TEST(TextureUnseen, WhatStoodInOnePhotographIsNotPaintedThoughFewSeeThePlace)
{
  const TriangleMesh mesh = cube();
  const auto grey = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(110 + 20 * std::sin(3 * p.x()), 120, 130); };
  std::vector<TextureView> views;
  for (const Eigen::Vector3d& eye :
       {Eigen::Vector3d(0.5, 0.3, 4.2), Eigen::Vector3d(-0.5, 0.2, 4), Eigen::Vector3d(0.1, -0.6, 4.4)})
    views.push_back(photograph(mesh, grey, camera(), lookAt(eye, {0, 0, 0})));
  for (int y = 60; y < 140; ++y)
    for (int x = 60; x < 110; ++x)
      std::copy_n(std::array<std::uint8_t, 3>{200, 30, 20}.data(), 3, views[1].image.pixel(x, y));
  const TextureResult result = reconstructTexture(mesh, views);
  int red = 0;
  forPlaces(mesh, 2000, [&](Index f, const Eigen::Vector3d& w) {
    const Eigen::Vector3d c = colorAt(result.model, f, w);
    red += pointAt(mesh, f, w).z() > 0.99 && c.x() > c.z() + 30;
  });
  EXPECT_EQ(red, 0);
}

/// Two of three views of the right half show red there, but other views of the left half tell what the red is.
TEST(TextureUnseen, WhatStoodInTwoOfThreePhotographsIsNoMajority)
{
  const TriangleMesh mesh = cube();
  const Pattern grey = [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(110 + 20 * std::sin(3 * p.x()), 120, 130);
  };
  const Pattern visited = [&](const Eigen::Vector3d& p) {
    const bool there = p.x() > -0.6 && p.x() < 0.25 && std::abs(p.y()) < 0.4 && p.z() > 0.99;
    return there ? Eigen::Vector3d(200, 30, 20) : grey(p);
  };
  std::vector<TextureView> views;
  for (int v = 0; v < 7; ++v) {
    const Eigen::Vector3d eye(0.2 * v - 0.6, 0.3 * (v % 3) - 0.3, 4 + 0.1 * v);
    views.push_back(photograph(mesh, v < 2 ? visited : grey, camera(), lookAt(eye, {0, 0, 0})));
    if (v < 3)
      continue;
    views[v].mask = Image(200, 200, 1, 0); // left half alone
    for (int y = 0; y < 200; ++y)
      std::fill_n(views[v].mask.pixel(0, y), 100, 255);
  }
  const TextureResult result = reconstructTexture(mesh, views);
  int red = 0;
  forPlaces(mesh, 2000, [&](Index f, const Eigen::Vector3d& w) {
    const Eigen::Vector3d c = colorAt(result.model, f, w), p = pointAt(mesh, f, w);
    const bool rim = p.x() > 0.2 || std::abs(p.y()) > 0.35; // patches there are of both colours
    red += p.z() > 0.99 && !rim && c.x() > c.z() + 30;
  });
  EXPECT_EQ(red, 0);
}

/// Four photographs from one place, before which a bar stands that the mesh has not, against three from elsewhere.
TEST(TextureUnseen, PhotographsFromOnePlaceAreOneWitness)
{
  TriangleMesh mesh, with_bar;
  appendBox({-1, -1, -1}, {1, 1, 1}, true, mesh);
  with_bar = mesh;
  appendBox({0.6F, -0.08F, -0.3F}, {0.66F, 0.08F, 0.3F}, false, with_bar);
  const auto light = [](const Eigen::Vector3d& p) {
    return p.x() < 0.7 && p.cwiseAbs().maxCoeff() < 0.7 ? Eigen::Vector3d(40, 40, 40)
                                                        : Eigen::Vector3d(0.4 * waves(p).array() + 100);
  };
  std::vector<TextureView> views;
  const auto look = [&](const Eigen::Vector3d& eye, const Eigen::Vector3d& at) {
    views.push_back(photograph(with_bar, light, camera(300, 300, 150), lookAt(eye, at)));
  };
  for (const double y : {-0.3, -0.1, 0.1, 0.3})
    look({-0.5, 0, 0}, {1, y, 0});
  for (const Eigen::Vector3d& eye :
       {Eigen::Vector3d(0, 0.8, -0.3), Eigen::Vector3d(0, -0.8, 0), Eigen::Vector3d(0, 0.9, 0.5)})
    look(eye, {1, 0, 0});
  TextureOptions options = withThreads(2);
  options.refine = false;
  const TextureResult result = reconstructTexture(mesh, views, options);
  double worst = 0;
  forPlaces(mesh, 3000, [&](Index f, const Eigen::Vector3d& weights) {
    const Eigen::Vector3d p = pointAt(mesh, f, weights);
    if (p.x() > 0.999 && std::abs(p.y()) < 0.15 && std::abs(p.z()) < 0.4)
      worst = std::max(worst, (colorAt(result.model, f, weights) - light(p)).cwiseAbs().maxCoeff());
  });
  EXPECT_LT(worst, 30);
}
} // namespace
} // namespace fresco::test
