// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/blank_pixels.h"
#include "photographs/photo_store.h"
#include "test_data.h"
#include "texture/texture_scene.h"
#include "views/visibility.h"
#include <fresco/io/image_io.h>
#include <gtest/gtest.h>
using namespace fresco::texture;
namespace fresco::test {
namespace {
constexpr int side = 200, frame = 22;

bool isInFrame(int x, int y) { return std::min({x, y, side - 1 - x, side - 1 - y}) < frame; }
bool isInCorner(int x, int y) { return std::hypot(x - 0.5 * side, y - 0.5 * side) > 0.55 * side; }

template <typename Where>
void fill(const Where& where, int value, Image& image)
{
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (where(x, y))
        std::fill_n(image.pixel(x, y), 3, value);
}

/// Means over 3 x 3 pixels.
Image softened(const Image& in)
{
  Image out = in;
  for (int y = 1; y + 1 < in.height; ++y)
    for (int x = 1; x + 1 < in.width; ++x)
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int k = 0; k < 9; ++k)
          sum += in.pixel(x - 1 + k % 3, y - 1 + k / 3)[c];
        out.pixel(x, y)[c] = static_cast<std::uint8_t>(sum / 9);
      }
  return out;
}

/// A picture of noise of so many grey levels around a slope from `low` to `high`, clipped.
Image slope(double low, double high, double noise)
{
  std::mt19937 random(3);
  std::normal_distribution<double> level(0, 1);
  Image out(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int c = 0; c < 3; ++c)
        out.pixel(x, y)[c] = static_cast<std::uint8_t>(
            std::lround(std::clamp(low + (high - low) * x / side + noise * level(random), 0.0, 255.0)));
  return out;
}

/// Where it is blank, and nowhere further away than `reach` pixels, the mask is 0.
template <typename Where>
void expectMask(const Image& mask, const Where& where, int reach)
{
  ASSERT_FALSE(mask.empty());
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      bool near = false;
      for (int j = std::max(0, y - reach); j <= std::min(side - 1, y + reach) && !near; ++j)
        for (int i = std::max(0, x - reach); i <= std::min(side - 1, x + reach) && !near; ++i)
          near = where(i, j);
      if (where(x, y)) {
        ASSERT_EQ(*mask.pixel(x, y), 0) << x << ' ' << y;
      } else if (!near) {
        ASSERT_EQ(*mask.pixel(x, y), 255) << x << ' ' << y;
      }
    }
}

TEST(BlankPixels, ABorderOfAnyValueAndShape)
{
  for (const int value : {0, 37, 255}) {
    Image framed = slope(90, 200, 3), round = framed;
    fill(isInFrame, value, framed);
    fill(isInCorner, value, round);
    expectMask(blankPixels(framed), isInFrame, 0);
    expectMask(blankPixels(round), isInCorner, 0);
    expectMask(blankPixels(softened(framed)), isInFrame, 1);
    expectMask(blankPixels(softened(softened(round))), isInCorner, 3);
  }
}

TEST(BlankPixels, ABorderSavedAsJpeg)
{
  for (const int width : {6, frame}) {
    Image photo = slope(90, 200, 3);
    const auto where = [&](int x, int y) { return std::min({x, y, side - 1 - x, side - 1 - y}) < width; };
    fill(where, 0, photo);
    const auto bytes = encodeImage(photo, ".jpg", 85);
    const Image decoded = decodeImage({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    expectMask(withinReach(blankPixels(decoded)), where, 4); // single pixels beside the picture ring more
  }
}

TEST(BlankPixels, AVignetteToBlack)
{
  constexpr double from = 0.36 * side, to = 0.48 * side; // from the middle: all is let through, nothing
  const auto radius = [](int x, int y) { return std::hypot(x - 0.5 * side, y - 0.5 * side); };
  Image photo = slope(90, 200, 3);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int c = 0; c < 3; ++c)
        photo.pixel(x, y)[c] *= std::clamp((to - radius(x, y)) / (to - from), 0.0, 1.0);
  const Image mask = blankPixels(photo);
  ASSERT_FALSE(mask.empty());
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double share = (to - radius(x, y)) / (to - from);
      if (share < 0.6) {
        ASSERT_EQ(*mask.pixel(x, y), 0) << x << ' ' << y;
      } else if (share > 1.2) {
        ASSERT_EQ(*mask.pixel(x, y), 255) << x << ' ' << y;
      }
    }
}

TEST(BlankPixels, TransparentPixels)
{
  Image photo(side, side, 4, 255), soft = photo;
  const Image colors = slope(90, 200, 3);
  Image black = colors;
  fill(isInCorner, 0, black);
  black = softened(black);
  for (int i = 0; i < side * side; ++i) {
    std::copy_n(&colors.data[3 * i], 3, &photo.data[4 * i]);
    std::copy_n(&black.data[3 * i], 3, &soft.data[4 * i]);
    photo.data[4 * i + 3] = soft.data[4 * i + 3] = isInCorner(i % side, i / side) ? 0 : 255;
  }
  expectMask(blankPixels(photo), isInCorner, 0);
  expectMask(blankPixels(soft), isInCorner, 2);
}

TEST(BlankPixels, PicturesOfDarkAndBrightThingsAreNotBlank)
{
  EXPECT_TRUE(blankPixels(slope(2, 2, 1)).empty());
  EXPECT_TRUE(blankPixels(slope(2, 200, 1)).empty());
  EXPECT_TRUE(blankPixels(slope(330, 150, 1)).empty()) << "clipped by degrees";
  EXPECT_TRUE(blankPixels(slope(-100, 60, 1)).empty());
  EXPECT_TRUE(blankPixels(Image(side, side, 3, 80)).empty()) << "one value, no border";
  Image half(side, side, 3, 80);
  fill([](int x, int) { return x < side / 2; }, 160, half);
  EXPECT_TRUE(blankPixels(half).empty()) << "surfaces of several values";
  Image screen = slope(90, 200, 3);
  fill([](int x, int y) { return x < 90 && y > 60 && y < 120; }, 0, screen);
  EXPECT_TRUE(blankPixels(screen).empty()) << "a dark thing that reaches into the picture";
}

TEST(BlankPixels, WhatIsBlankBesideTheSurfaceHidesNothing)
{
  texture::DepthMap map = emptyMap(camera(side, side), side * side);
  Image mask(side, side, 1, 255);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      if (x < frame)
        *mask.pixel(x, y) = 0;
      else
        map.depth[x + side * y] = 2;
  const auto before = map.depth;
  hideMasked(mask, map);
  EXPECT_EQ(map.depth, before);
  *mask.pixel(100, 100) = 0;
  hideMasked(mask, map);
  EXPECT_LT(map.at(102, 98), 1) << "within reach of interpolation";
  EXPECT_EQ(map.at(104, 100), 2);
}

/// A room, photographed from its inside in all directions.
struct Room {
  TriangleMesh mesh;
  std::vector<TextureView> views;

  Room()
  {
    appendBox({-1, -1, -1}, {1, 1, 1}, true, mesh);
    for (const auto& to : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, 1, 0),
                           Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1)})
      views.push_back(photograph(mesh, waves, camera(side, side, 80), lookAt(-0.3 * to, to)));
  }
};

TEST(BlankPixels, ModelsAreAsWithoutBorder)
{
  const Room room;
  TextureOptions options = withThreads(2);
  options.refine = false;
  const TextureResult whole = reconstructTexture(room.mesh, room.views, options);
  for (const int value : {0, 37, 255}) {
    std::vector<TextureView> views = room.views;
    for (TextureView& view : views)
      fill(isInFrame, value, view.image);
    const TextureResult result = reconstructTexture(room.mesh, views, options);
    EXPECT_EQ(std::count_if(result.warnings.begin(), result.warnings.end(),
                            [](const std::string& w) { return w.find("border") != std::string::npos; }),
              1);
    EXPECT_GT(result.blank[3], 0.1);
    double largest = 0;
    forPlaces(room.mesh, 300, [&](Index f, const Eigen::Vector3d& weights) {
      const Eigen::Array3d p = pointAt(room.mesh, f, weights).array().abs();
      if ((p > 0.7).count() == 1)
        largest = std::max(
            largest, (colorAt(result.model, f, weights) - colorAt(whole.model, f, weights)).cwiseAbs().maxCoeff());
    });
    EXPECT_LT(largest, 3) << value;
  }
  for (const std::string& warning : whole.warnings)
    EXPECT_EQ(warning.find("border"), std::string::npos) << warning;
}

TEST(BlankPixels, AlphaOfAPngFileIsRead)
{
  const std::string path = testing::TempDir() + "blank_alpha.png";
  Image photo(side, side, 4, 255);
  photo.pixel(5, 7)[3] = 0;
  writeImage(path, photo);
  EXPECT_EQ(readPhotograph(path, camera(side, side)).data, photo.data);
  EXPECT_EQ(readImage(path).channels, 3);
}
} // namespace
} // namespace fresco::test
