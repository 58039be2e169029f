// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/picture_fixtures.h"
#include <fresco/rendering/scale_bar.h>
#include <gtest/gtest.h>
using namespace fresco::rendering;
namespace fresco {
namespace {
using namespace test;

/// Shading makes a colour darker, not different: the largest channel becomes 255.
std::array<int, 3> atFullStrength(const std::array<int, 3>& color)
{
  const int most = std::max({color[0], color[1], color[2], 1});
  return {color[0] * 255 / most, color[1] * 255 / most, color[2] * 255 / most};
}

std::array<int, 3> centreColor(float distance, double limit)
{
  const TriangleMesh ball = sphere(1.f, 4);
  PictureOptions options = optionsFor(Shading::Error, 400, 300);
  options.error_limit = limit;
  const Image image = renderErrorPicture(ball, Eigen::VectorXf::Constant(ball.vertexCount(), distance), options);
  EXPECT_EQ(image.width, 400);
  EXPECT_EQ(image.height, 300);
  return atFullStrength(rgb(image, 160, 150)); // the bar takes a part of the right side
}

TEST(ErrorPicture, ZeroIsRedHalfIsGreenAndLargeIsBlue)
{
  EXPECT_LE(difference(centreColor(0.f, 1), {255, 0, 0}), 3);
  EXPECT_LE(difference(centreColor(0.5f, 1), {0, 255, 0}), 3);
  EXPECT_LE(difference(centreColor(1.f, 1), {0, 0, 255}), 3);
  EXPECT_LE(difference(centreColor(7.f, 1), {0, 0, 255}), 3);
  EXPECT_LE(difference(centreColor(0.f, 0), {255, 0, 0}), 3); // no error at all: the scale has no natural end
}

TEST(ErrorPicture, DistancesBetweenVerticesAreColoredNotColorsMixed)
{
  const TriangleMesh square = texturedSquare(Image(1, 1)).mesh;
  PictureOptions options = optionsFor(Shading::Error, 400, 300);
  options.error_limit = 1;
  options.view = squareView();
  const Image image = renderErrorPicture(square, Eigen::Vector4f(0, 1, 1, 0), options);
  bool green = false;
  for (int x = 20; x < 300; ++x)
    green |= difference(atFullStrength(rgb(image, x, 150)), {0, 255, 0}) <= 8; // half way from red to blue
  EXPECT_TRUE(green);
}

TEST(ErrorPicture, BarRunsFromRedAtTheBottomToBlueAtTheTop)
{
  const TriangleMesh ball = sphere(1.f, 3);
  const Eigen::VectorXf distances = (ball.vertices.row(2).array() + 1.f).transpose();
  for (const bool transparent : {false, true}) {
    PictureOptions options = optionsFor(Shading::Error, 640, 480);
    options.transparent = transparent;
    options.unit = "mm";
    const Image image = renderErrorPicture(ball, distances, options);
    ASSERT_EQ(image.channels, transparent ? 4 : 3);
    ScaleBar bar;
    bar.largest = 2;
    bar.title = {"distance", "(mm)"};
    const int x = image.width - scaleBarWidth(bar, image.height) + 12;
    const int bottom = image.height - image.height / 12 - 4;
    EXPECT_LE(difference(rgb(image, x, bottom), {255, 0, 0}), 12);
    int top = bottom;
    while (top > 0 && difference(rgb(image, x, top), {0, 0, 255}) > 4)
      --top;
    EXPECT_GT(top, image.height / 12);
    EXPECT_LT(top, image.height / 3);
    EXPECT_LE(difference(rgb(image, x, (top + bottom) / 2), {0, 255, 0}), 40);
    EXPECT_EQ(image.pixel(x, bottom)[image.channels - 1], transparent ? 255 : image.pixel(x, bottom)[2]);
  }
}

TEST(ErrorPicture, TheBarHidesNothingOfTheView)
{
  const TriangleMesh ball = sphere(1.f, 5);
  PictureOptions options = optionsFor(Shading::Error, 400, 300);
  options.transparent = true;
  Framing framing;
  framing.aspect = 1; // fills a square; the picture is wider, so the view below is widened to fit the sides exactly
  options.view = frameView(ball, framing);
  options.view->angle = 2 * std::atan(std::tan(options.view->angle * pi / 360) * 300 / 400) * 180 / pi;
  const Image image = renderErrorPicture(ball, Eigen::VectorXf::Zero(ball.vertexCount()), options);
  double covered = 0;
  int at_left = 0;
  for (int y = 0; y < 300; ++y) {
    at_left += image.pixel(0, y)[3] > 0;
    for (int x = 0; x < 320; ++x)
      covered += difference(atFullStrength(rgb(image, x, y)), {255, 0, 0}) <= 3 && image.pixel(x, y)[3] == 255;
  }
  EXPECT_EQ(at_left, 0);
  EXPECT_GT(covered, 0.25 * 400 * 300);
}

TEST(ErrorPicture, LettersStandUprightAboveTheBar)
{
  Image image(200, 300, 3, 255);
  ScaleBar bar;
  bar.title = {"L"};
  drawScaleBar(image, bar);
  std::vector<int> ink; // dark pixels of the rows above the bar that have some
  const int left = image.width - scaleBarWidth(bar, image.height);
  for (int y = 0, colored = 0; y < image.height && !colored; ++y) {
    int dark = 0;
    for (int x = left; x < left + 20; ++x) {
      dark += image.pixel(x, y)[0] < 200;
      colored += image.pixel(x, y)[0] != image.pixel(x, y)[2];
    }
    if (dark > 0)
      ink.push_back(dark);
  }
  ASSERT_GT(ink.size(), 6u);
  ink.pop_back(); // the bar's rim and its first row
  ink.pop_back();
  EXPECT_GE(ink.back(), 2 * ink.front()) << "the foot of the L";
}

TEST(ErrorPicture, TicksAreRoundAndCoverTheScale)
{
  for (const double largest : {1.0, 0.0375, 2.0, 4.99, 6e-7, 123456.0, 1e12}) {
    const std::vector<double> ticks = roundTicks(largest);
    EXPECT_GE(ticks.size(), 4u) << largest;
    EXPECT_LE(ticks.size(), 11u) << largest;
    EXPECT_EQ(ticks.front(), 0.0);
    EXPECT_LE(ticks.back(), largest * (1 + 1e-6));
    EXPECT_GT(ticks.back() + ticks[1], largest);
  }
  EXPECT_THROW(roundTicks(0), std::invalid_argument);
  EXPECT_THROW(roundTicks(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

TEST(ErrorPicture, BadInputIsRefused)
{
  const TriangleMesh ball = sphere(1.f, 1);
  const Eigen::VectorXf zero = Eigen::VectorXf::Zero(ball.vertexCount());
  const auto refused = [](const TriangleMesh& mesh, const Eigen::VectorXf& distances, const PictureOptions& options) {
    EXPECT_THROW(renderErrorPicture(mesh, distances, options), std::invalid_argument);
  };
  refused(ball, zero.head(3), {});
  Eigen::VectorXf bad = zero;
  bad[2] = -1;
  refused(ball, bad, {});
  bad[2] = std::numeric_limits<float>::quiet_NaN();
  refused(ball, bad, {});
  TriangleMesh points = ball;
  points.faces.resize(3, 0);
  refused(points, zero, {});
  refused(ball, zero, optionsFor(Shading::Error, 100, 100));
  PictureOptions options;
  options.error_limit = -1;
  refused(ball, zero, options);
}
} // namespace
} // namespace fresco
