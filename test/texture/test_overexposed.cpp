// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/color_fringe.h"
#include "texture/texture_scene.h"
#include <gtest/gtest.h>
using namespace fresco::texture;
namespace fresco::test {
namespace {
constexpr int side = 200, edge = 100, fringe = 5;

/// Clipped up to the edge, then of a colour with noise; pixels of the edge are mixed.
Image backlit(const Eigen::Vector3d& color)
{
  std::mt19937 random(5);
  std::normal_distribution<double> level(0, 2);
  Image out(side, side, 3, 255);
  for (int y = 0; y < side; ++y)
    for (int x = edge; x < side; ++x)
      for (int c = 0; c < 3; ++c)
        out.pixel(x, y)[c] =
            std::clamp(color[c] + level(random) + (x == edge ? 0.5 * (255 - color[c]) : 0), 0.0, 255.0);
  return out;
}

void addViolet(Image& photo)
{
  for (int y = 0; y < side; ++y)
    for (int x = edge + 1; x <= edge + fringe; ++x)
      for (const int c : {0, 2})
        photo.pixel(x, y)[c] = std::min(255, photo.pixel(x, y)[c] + 90);
}

int violet(const std::uint8_t* p) { return std::min(p[0], p[2]) - p[1]; }

TEST(ColorFringe, IsFoundAndTakesTheColourBeyond)
{
  for (const Eigen::Vector3d& color : {Eigen::Vector3d(40, 45, 50), Eigen::Vector3d(30, 80, 30)}) {
    Image photo = backlit(color);
    addViolet(photo);
    const int width = fringeWidth(photo);
    EXPECT_NEAR(width, fringe, 2);
    const Image clean = withoutFringe(photo, width);
    for (int y = 0; y < side; ++y)
      for (int x = edge + 1; x < side; ++x) {
        ASSERT_NEAR(violet(clean.pixel(x, y)), color.minCoeff() - color[1], 30) << x;
        ASSERT_LT(violet(clean.pixel(x, y)), 14) << x;
        ASSERT_EQ(clean.pixel(x, y)[1], photo.pixel(x, y)[1]) << "green stays";
      }
  }
}

TEST(ColorFringe, IsNotFoundWhereThereIsNone)
{
  EXPECT_EQ(fringeWidth(backlit({40, 45, 50})), 0);
  EXPECT_EQ(fringeWidth(backlit({30, 90, 30})), 0);
  EXPECT_EQ(fringeWidth(backlit({120, 40, 110})), 0) << "a violet thing before a lamp";
  EXPECT_EQ(fringeWidth(Image(side, side, 3, 90)), 0) << "nothing is clipped";
  EXPECT_EQ(fringeWidth(Image(side, side, 3, 255)), 0);
}

/// A wall of grey that grows upwards, which one photograph shows overexposed, and one of less light as far as y = 0.2 or so.
struct OverexposedWall {
  double middle, rise;    ///< grey levels of the wall
  Eigen::Vector3d factor; ///< of the light of the first photograph
  TriangleMesh mesh;
  std::vector<TextureView> views;

  Eigen::Vector3d color(const Eigen::Vector3d& p) const
  {
    const double wall = middle + rise * p.z(), other = 70 + 30 * std::sin(4 * p.x() + 5 * p.y() + 3 * p.z());
    return Eigen::Vector3d::Constant(p.x() > 0.999 ? wall : other);
  }

  OverexposedWall(double grey, double more, const Eigen::Vector3d& gain) : middle(grey), rise(more), factor(gain)
  {
    appendBox({-1, -1, -1}, {1, 1, 1}, true, mesh);
    const CameraModel wide = camera(side, side, 70);
    const auto light = [this](const Eigen::Vector3d& p) { return color(p); };
    views.push_back(photograph(mesh, light, wide, lookAt({-0.7, 0, 0}, {1, 0, 0}), factor));
    views.push_back(photograph(mesh, light, wide, lookAt({-0.7, -0.7, 0}, {0, 1, 0})));
    views.push_back(photograph(mesh, light, wide, lookAt({0.5, 0.5, 0}, {-1, 0, 0})));
  }

  TextureResult texture() const
  {
    TextureOptions options = withThreads(2);
    options.refine = false;
    return reconstructTexture(mesh, views, options);
  }

  /// visit(place of the wall, its colour in the model)
  template <typename Visit>
  void forWall(const TexturedMesh& model, const Visit& visit) const
  {
    forPlaces(mesh, 3000, [&](Index f, const Eigen::Vector3d& weights) {
      const Eigen::Vector3d p = pointAt(mesh, f, weights);
      if (p.x() > 0.999 && std::abs(p.y()) < 0.9 && std::abs(p.z()) < 0.9)
        visit(p, colorAt(model, f, weights));
    });
  }
};

TEST(Overexposed, WhatOnlyClippedPhotographsShowContinuesItsSurroundings)
{
  const OverexposedWall scene(155, 10, {2, 2, 2});
  const TextureResult result = scene.texture();
  const double gain = result.gains(1, 0), least = 255 * gain;
  EXPECT_NEAR(result.gains(1, 1) / gain, 2, 0.1);
  constexpr int bins = 36;
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(bins), count = sum;
  scene.forWall(result.model, [&](const Eigen::Vector3d& p, const Eigen::Vector3d& color) {
    const double value = color.mean();
    EXPECT_GT(value, least - 2);
    const int bin = static_cast<int>((p.y() + 0.9) / 1.8 * bins);
    sum[bin] += value;
    ++count[bin];
  });
  const Eigen::ArrayXd mean = sum / count;
  double step = 0;
  for (int b = 1; b < bins; ++b)
    step = std::max(step, std::abs(mean[b] - mean[b - 1]));
  EXPECT_LT(step, 4) << mean.transpose();
  EXPECT_GT(mean.maxCoeff(), least + 10) << "a part is seen as bright as it is";
}

/// Red is clipped first, then green: what is left of them tells the light, not the hue.
TEST(Overexposed, WhatIsClippedHasTheHueOfItsSurroundings)
{
  for (const double rise : {10, 25}) {
    const OverexposedWall scene(rise < 20 ? 155 : 130, rise, {2.2, 2, 1.8});
    const TextureResult result = scene.texture();
    const Eigen::Vector3d clear = result.gains.col(1).cast<double>(), least = 255 * result.gains.col(0).cast<double>();
    double tint = 0, dull = 0;
    scene.forWall(result.model, [&](const Eigen::Vector3d& p, const Eigen::Vector3d& color) {
      const Eigen::Vector3d grey = color.cwiseQuotient(clear);
      tint = std::max(tint, grey.maxCoeff() - grey.minCoeff());
      const Eigen::Vector3d shown = scene.factor.cwiseProduct(scene.color(p)); // by the first photograph
      dull = std::max(dull, (shown.array() > 260).select(least - color, 0).maxCoeff());
    });
    EXPECT_LT(tint, 8) << rise;
    EXPECT_LT(dull, 3) << rise;
  }
}

/// A lamp or the sky: what stood before it in one photograph is not of it, for all that it is not overexposed.
TEST(Overexposed, WhatMostPhotographsShowClippedIsNoDarkThing)
{
  TriangleMesh mesh;
  appendBox({-1, -1, -1}, {1, 1, 1}, true, mesh);
  std::vector<TextureView> views;
  const auto bright = [](const Eigen::Vector3d& p) {
    const double other = 90 + 40 * std::sin(4 * p.x() + 5 * p.y() + 3 * p.z());
    return Eigen::Vector3d::Constant(p.x() > 0.999 ? 320 : other);
  };
  const auto hidden = [&](const Eigen::Vector3d& p) {
    return p.x() > 0.999 && p.tail<2>().norm() < 0.5 ? Eigen::Vector3d(40, 90, 30) : bright(p);
  };
  const CameraModel wide = camera(side, side, 70);
  for (const double y : {-0.6, -0.2, 0.2, 0.6})
    views.push_back(photograph(mesh, bright, wide, lookAt({-0.7, y, 0.3 * y}, {1, 0, 0})));
  views.push_back(photograph(mesh, hidden, wide, lookAt({-0.2, 0, 0}, {1, 0, 0})));
  TextureOptions options = withThreads(2);
  options.refine = false;
  const TextureResult result = reconstructTexture(mesh, views, options);
  double darkest = 255;
  forPlaces(mesh, 3000, [&](Index f, const Eigen::Vector3d& weights) {
    const Eigen::Vector3d p = pointAt(mesh, f, weights);
    if (p.x() > 0.999 && p.tail<2>().norm() < 0.45)
      darkest = std::min(darkest, colorAt(result.model, f, weights).minCoeff());
  });
  EXPECT_GT(darkest, 240);
}
} // namespace
} // namespace fresco::test
