// SPDX-License-Identifier: BSD-3-Clause
#include "filling/exemplar_synthesis.h"
#include "painting/color_growth.h"
#include "photographs/input_checks.h"
#include "test_data.h"
#include "texture/texture_scene.h"
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
using namespace fresco::texture;
namespace fresco::test {
namespace {
HolePicture::Color stripes(int x, int y)
{
  return HolePicture::stored((x + 2 * y) % 9 < 4 ? Eigen::Vector4f(60, 20, 10, 0) : Eigen::Vector4f(-40, 5, 30, 0));
}

/// Stripes with a square hole of `side` in the middle.
HolePicture stripedPicture(int size, int side)
{
  HolePicture picture;
  picture.width = picture.height = size;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const bool in = std::abs(2 * x - size) < side && std::abs(2 * y - size) < side;
      picture.state.push_back(in ? HolePicture::hole : HolePicture::known);
      picture.color.push_back(in ? HolePicture::Color{} : stripes(x, y));
    }
  return picture;
}

TEST(TextureUnseen, APatternIsContinuedThroughAHole)
{
  HolePicture picture = stripedPicture(90, 30);
  ASSERT_TRUE(synthesizeHole(picture, 1));
  int right = 0, all = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 90; ++x)
      if (picture.state[picture.at(x, y)] == HolePicture::hole) {
        right += picture.color[picture.at(x, y)] == stripes(x, y);
        ++all;
      } else {
        EXPECT_EQ(picture.color[picture.at(x, y)], stripes(x, y));
      }
  EXPECT_GT(right, 0.9 * all);
}

TEST(TextureUnseen, SynthesisIsRepeatable)
{
  HolePicture a = stripedPicture(60, 20), b = a;
  ASSERT_TRUE(synthesizeHole(a, 5));
  ASSERT_TRUE(synthesizeHole(b, 5));
  EXPECT_EQ(a.color, b.color);
}

TEST(TextureUnseen, WithoutExamplesNothingIsDone)
{
  HolePicture picture = stripedPicture(40, 38);
  const auto before = picture.color;
  EXPECT_FALSE(synthesizeHole(picture, 1));
  EXPECT_EQ(picture.color, before);
}

TEST(TextureUnseen, RadiusOfAHole)
{
  EXPECT_EQ(holeRadius(stripedPicture(60, 21)), 11);
  EXPECT_EQ(holeRadius(stripedPicture(60, 0)), 0);
}

/// A floor with a fine pattern, and a board above the middle of it that hides a part from every view.
struct FloorUnderABoard {
  TriangleMesh mesh;
  std::vector<TextureView> views;

  static Eigen::Vector3d pattern(const Eigen::Vector3d& p)
  {
    const double wave = std::sin(70 * p.x()) + std::sin(55 * p.y() + 1);
    return p.z() > 0.05 ? Eigen::Vector3d(200, 60, 60) : Eigen::Vector3d(120 + 25 * wave, 130 + 20 * wave, 110);
  }

  FloorUnderABoard()
  {
    appendBox({-1, -1, -0.2f}, {1, 1, 0}, false, mesh);
    appendBox({-0.45f, -0.45f, 0.1f}, {0.45f, 0.45f, 0.2f}, false, mesh);
    for (const Eigen::Vector3d& eye :
         {Eigen::Vector3d(0.3, 0.2, 3), Eigen::Vector3d(-0.3, 0.3, 3), Eigen::Vector3d(0, -0.4, 3)})
      views.push_back(photograph(mesh, pattern, camera(320, 320, 400), lookAt(eye, {0, 0, 0})));
  }
};

/// Deviation of green over the floor's texels in the middle, which no view sees, or around it.
double roughness(const TextureResult& result, bool middle)
{
  double sum = 0, squares = 0, count = 0;
  forPlaces(result.model.mesh, 4000, [&](Index f, const Eigen::Vector3d& weights) {
    const Eigen::Vector3d p = pointAt(result.model.mesh, f, weights);
    const double radius = std::max(std::abs(p.x()), std::abs(p.y()));
    if (std::abs(p.z()) > 1e-3 || (middle ? radius > 0.2 : radius < 0.7 || radius > 0.95))
      return;
    const double green = colorAt(result.model, f, weights).y();
    sum += green;
    squares += green * green;
    ++count;
  });
  return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
}

TEST(TextureUnseen, AFloorUnderABoardLooksLikeTheFloor)
{
  const FloorUnderABoard scene;
  TextureOptions options = withThreads(1);
  options.refine = false;
  const TextureResult with = reconstructTexture(scene.mesh, scene.views, options);
  EXPECT_TRUE(std::any_of(with.masks[0].data.begin(), with.masks[0].data.end(), [](int v) { return v == 255; }));
  const double seen = roughness(with, false);
  EXPECT_GT(seen, 15);
  EXPECT_NEAR(roughness(with, true), seen, 0.4 * seen);
  options.threads = 4;
  EXPECT_TRUE(sameAtlases(with, reconstructTexture(scene.mesh, scene.views, options)));
  options.examples = false;
  EXPECT_LT(roughness(reconstructTexture(scene.mesh, scene.views, options), true), 0.3 * seen);
}

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
} // namespace
} // namespace fresco::test
