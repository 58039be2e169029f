// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/picture_fixtures.h"
#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <unistd.h>
namespace fresco {
namespace {
using namespace test;

TEST(Picture, SphereCoversTheShareOfThePictureThatPerspectiveGives)
{
  const TriangleMesh ball = sphere(1.f, 6);
  for (const auto& [width, height] : {std::pair{320, 240}, {150, 301}}) {
    PictureOptions options = optionsFor(Shading::Gouraud, width, height);
    options.transparent = true;
    options.view = from({4, 1, 2}, 60);
    const Image image = renderPicture(ball, options);
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(image.height, height);
    ASSERT_EQ(image.channels, 4);
    double covered = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        covered += image.pixel(x, y)[3] / 255.0;
    const double distance = options.view->eye.norm();
    const double radius = std::tan(std::asin(1 / distance)) / std::tan(pi / 6) * height / 2;
    EXPECT_NEAR(covered / (pi * radius * radius), 1.0, 0.005) << width;
  }
}

TEST(Picture, NormalColorAtTheCentreIsTheDirectionToTheEye)
{
  const TriangleMesh ball = sphere(2.f, 6);
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-0.3, 0.5, 0.8),
                                           Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, -1, 1)}) {
    PictureOptions options = optionsFor(Shading::Normals, 101, 75);
    options.view = from(9 * direction.normalized(), 40);
    const Image image = renderPicture(ball, options);
    EXPECT_EQ(image.channels, 3);
    const Eigen::Vector3d expected = 127.5 * (direction.normalized().array() + 1.0);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(image.pixel(50, 37)[c], expected[c], 3.0) << direction.transpose(); // a face tilts by up to 1 degree
  }
}

TEST(Picture, LitShadingsAreBrighterTowardsTheEyeThanAtTheRim)
{
  const TriangleMesh ball = sphere(1.f, 5);
  for (const Shading shading : {Shading::Gouraud, Shading::Flat, Shading::Wireframe}) {
    PictureOptions options = optionsFor(shading, 240, 240);
    options.view = from({0, -5, 0}, 30);
    const Image image = renderPicture(ball, options);
    EXPECT_GT(image.pixel(120, 110)[1], 100);
    EXPECT_LT(image.pixel(120, 195)[1], image.pixel(120, 110)[1] - 20);
    EXPECT_EQ(rgb(image, 2, 2), (std::array<int, 3>{255, 255, 255}));
  }
}

TEST(Picture, GouraudIsSmoothOnASphereAndSharpOnABox)
{
  PictureOptions options = optionsFor(Shading::Gouraud, 200, 200);
  options.view = from({0, -6, 0}, 25);
  const Image ball = renderPicture(sphere(1.f, 4), options);
  for (int x = 60; x < 140; ++x)
    EXPECT_LE(std::abs(ball.pixel(x, 100)[1] - ball.pixel(x + 1, 100)[1]), 4) << x;
  TriangleMesh box;
  addBox(box, {-1, -1, -1}, {1, 1, 1}, false);
  const Image cube = renderPicture(box, options);
  int least = 255, most = 0;
  for (int x = 60; x < 140; ++x) {
    least = std::min<int>(least, cube.pixel(x, 100)[1]);
    most = std::max<int>(most, cube.pixel(x, 100)[1]);
  }
  EXPECT_LE(most - least, 3); // one flat side, not rounded off by the neighbours' normals
}

TEST(Picture, VertexColorsShow)
{
  TriangleMesh square = texturedSquare(Image(1, 1)).mesh;
  square.colors.resize(3, 4);
  square.colors << 200, 200, 200, 200, 20, 20, 20, 20, 40, 40, 40, 40;
  PictureOptions options = optionsFor(Shading::Gouraud, 60, 60);
  options.view = squareView();
  const auto color = rgb(renderPicture(square, options), 30, 30);
  EXPECT_GT(color[0], 120);
  EXPECT_LT(color[1], color[0] / 3);
}

TEST(Picture, WireframeShowsEdgesThatAreNotHidden)
{
  TriangleMesh box;
  addBox(box, {-1, -1, -1}, {1, 1, 1}, false);
  PictureOptions options = optionsFor(Shading::Wireframe, 200, 200);
  options.view = from({0, -5, 0}, 32);
  const Image image = renderPicture(box, options);
  std::vector<int> dark;
  for (int x = 2; x < 198; ++x)
    if (image.pixel(x, 70)[1] < 170)
      dark.push_back(x);
  // Two upright edges and one diagonal of the near side; the far side's lie closer to the middle and are hidden.
  const double near_half = 100.0 * 1 / 4 / std::tan(16 * pi / 180);
  ASSERT_GE(dark.size(), 3u);
  EXPECT_NEAR(dark.front(), 100 - near_half, 2.5);
  EXPECT_NEAR(dark.back(), 100 + near_half, 2.5);
  EXPECT_LT(dark.size(), 12u);
}

TEST(Picture, CullingLooksIntoARoomFromOutside)
{
  TriangleMesh room;
  addBox(room, {-2, -2, -1}, {2, 2, 1}, true);
  PictureOptions options = optionsFor(Shading::Normals, 80, 60);
  options.view = from({12, 0, 0}, 20);
  const auto front = rgb(renderPicture(room, options), 40, 30);
  options.cull_back_faces = true;
  const auto inside = rgb(renderPicture(room, options), 40, 30);
  EXPECT_LE(difference(front, {0, 128, 128}), 1);    // the near wall, whose front shows to -x
  EXPECT_LE(difference(inside, {255, 128, 128}), 1); // the far wall
}

TEST(Picture, TransparentPicturesHaveCleanRims)
{
  TriangleMesh square = texturedSquare(Image(1, 1)).mesh;
  PictureOptions options = optionsFor(Shading::Normals, 120, 120);
  options.transparent = true;
  options.view = squareView();
  options.view->angle = 45;
  options.view->up = {0.3, 1, 0}; // oblique edges make pixels that are partly covered
  const Image image = renderPicture(square, options);
  EXPECT_EQ(image.pixel(1, 1)[3], 0);
  EXPECT_EQ(image.pixel(60, 60)[3], 255);
  int rim = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int alpha = image.pixel(x, y)[3];
      rim += alpha > 0 && alpha < 255;
      EXPECT_TRUE(alpha == 0 || difference(rgb(image, x, y), {128, 128, 255}) <= 2) << x << " " << y;
    }
  EXPECT_GT(rim, 50);
}

TEST(Picture, TheSameOnEveryCallThreadCountAndOrigin)
{
  TriangleMesh ball = sphere(1.f, 4);
  PictureOptions options = optionsFor(Shading::Gouraud);
  options.threads = 1;
  const Image first = renderPicture(ball, options);
  options.width = 77;
  options.height = 33;
  EXPECT_EQ(renderPicture(ball, options).width, 77);
  options = optionsFor(Shading::Gouraud);
  options.threads = 4;
  EXPECT_EQ(renderPicture(ball, options).data, first.data);
  ball.origin = {500000, 5400000, 300};
  const Image moved = renderPicture(ball, options);
  int largest = 0;
  for (std::size_t i = 0; i < moved.data.size(); ++i)
    largest = std::max(largest, std::abs(moved.data[i] - first.data[i]));
  EXPECT_LE(largest, 2);
}

TEST(Picture, VertexOfNoFaceDoesNotMatterEvenIfNotFinite)
{
  TriangleMesh ball = sphere(1.f, 4);
  const Image clean = renderPicture(ball, optionsFor(Shading::Flat));
  ball.vertices.conservativeResize(3, ball.vertices.cols() + 2);
  ball.vertices.rightCols(2).col(0).setConstant(std::numeric_limits<float>::quiet_NaN());
  ball.vertices.rightCols(1).setConstant(1e6f);
  EXPECT_EQ(renderPicture(ball, optionsFor(Shading::Flat)).data, clean.data);
}

TEST(Picture, PointsAreDrawnAndNonFiniteOnesLeftOut)
{
  PointSet set;
  const TriangleMesh ball = sphere(1.f, 5);
  set.points = ball.vertices;
  set.points.conservativeResize(3, set.points.cols() + 1);
  set.points.rightCols(1).setConstant(std::numeric_limits<float>::infinity());
  PictureOptions options = optionsFor(Shading::Gouraud);
  options.transparent = true;
  options.view = from({0, -5, 0}, 30);
  options.point_size = 4;
  const Image plain = renderPicture(set, options);
  EXPECT_EQ(plain.pixel(100, 75)[3], 255);
  EXPECT_EQ(plain.pixel(2, 2)[3], 0);
  set.colors = Colors::Constant(3, set.points.cols(), 77);
  EXPECT_LE(difference(rgb(renderPicture(set, options), 100, 75), {77, 77, 77}), 1);
  set.normals = Points::Zero(3, set.points.cols());
  set.normals.row(1).setConstant(-1.f);
  options.shading = Shading::Normals;
  EXPECT_LE(difference(rgb(renderPicture(set, options), 100, 75), {128, 0, 128}), 1);
}

TEST(Picture, PlainPicturesShowTheShapeAlone)
{
  TriangleMesh ball = sphere(1.f, 4);
  PictureOptions options = optionsFor(Shading::Gouraud);
  const Image bare = renderPicture(ball, options);
  ball.colors = Colors::Constant(3, ball.vertexCount(), 9);
  EXPECT_NE(renderPicture(ball, options).data, bare.data);
  options.no_colors = true;
  EXPECT_EQ(renderPicture(ball, options).data, bare.data);
  PointSet set;
  set.points = ball.vertices;
  const Image points = renderPicture(set, options);
  set.colors = ball.colors;
  set.intensities = ball.vertices.row(0).transpose();
  EXPECT_EQ(renderPicture(set, options).data, points.data);
}

TEST(Picture, CulledPointsAreThoseTurnedToTheEye)
{
  const TriangleMesh ball = sphere(1.f, 5);
  PointSet set;
  set.points = ball.vertices;
  set.normals = ball.vertices; // outward
  set.colors = Colors::Constant(3, set.size(), 40);
  for (Index i = 0; i < set.size(); ++i)
    if (set.points(1, i) < -0.2f) // what an eye 5 away sees of the ball
      set.colors.col(i).setConstant(200);
  PictureOptions options = optionsFor(Shading::PointCloud);
  options.view = from({0, -5, 0}, 30);
  options.point_size = 1; // the far half shows between the near points
  const auto pixels = [&](std::uint8_t value) {
    const Image image = renderPicture(set, options);
    return std::count(image.data.begin(), image.data.end(), value) / 3;
  };
  const auto near = pixels(200), far = pixels(40);
  EXPECT_GT(near, 100);
  EXPECT_GT(far, 20);
  options.cull_back_faces = true;
  EXPECT_EQ(pixels(40), 0);
  EXPECT_GT(pixels(200), near / 2);
  set.normals =
      -set.normals; // inward: the far side alone; a few pixels of its rim are mixed with white to the same grey
  EXPECT_GT(pixels(40), far);
  EXPECT_LT(pixels(200), near / 4);
}

long residentPages()
{
  long size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return resident;
}

TEST(Picture, ManyPicturesDoNotPileUpMemory)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer keeps memory that has been freed";
#endif
  const TriangleMesh ball = sphere(1.f, 5);
  const TexturedMesh square = texturedSquare(Image(512, 512, 3, 90));
  const auto draw = [&](int count) {
    for (int i = 0; i < count; ++i) {
      renderPicture(ball, optionsFor(Shading::Gouraud, 300 + i, 200));
      renderPicture(square, optionsFor(Shading::Texture, 300, 200 + i));
    }
  };
  draw(6);
  const long before = residentPages();
  draw(12);
  const double grown = static_cast<double>(residentPages() - before) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
  EXPECT_LT(grown / 24, 0.25) << grown << " MB more after 24 pictures";
}

TEST(Picture, BadInputIsRefused)
{
  const TriangleMesh ball = sphere(1.f, 1);
  const auto refused = [&](const PictureOptions& options) {
    EXPECT_THROW(renderPicture(ball, options), std::invalid_argument);
  };
  EXPECT_THROW(renderPicture(TriangleMesh{}), std::invalid_argument);
  EXPECT_THROW(renderPicture(PointSet{}), std::invalid_argument);
  TriangleMesh broken = ball;
  broken.faces(0, 0) = 1000;
  EXPECT_THROW(renderPicture(broken), std::invalid_argument);
  broken = ball;
  broken.vertices(1, 2) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(renderPicture(broken), std::invalid_argument);
  refused(optionsFor(Shading::Texture));
  refused(optionsFor(Shading::Error));
  refused(optionsFor(Shading::Flat, 0, 10));
  refused(optionsFor(Shading::Flat, 10, -1));
  PictureOptions options;
  options.crease_angle = std::numeric_limits<double>::quiet_NaN();
  refused(options);
  options = {};
  options.oversampling = 5;
  refused(options);
  options = {};
  options.point_size = -1;
  refused(options);
  options = {};
  options.view = from({0, 0, 0}, 30); // eye and look coincide
  refused(options);
  options.view = from({5, 0, 0}, 180);
  refused(options);
  options.view = from({std::numeric_limits<double>::quiet_NaN(), 0, 0}, 30);
  refused(options);
  PointSet set;
  set.points = ball.vertices;
  EXPECT_THROW(renderPicture(set, optionsFor(Shading::Normals)), std::invalid_argument);
  set.points.setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_THROW(renderPicture(set), std::invalid_argument);
  EXPECT_THROW(shadingByName("phong"), std::invalid_argument);
  EXPECT_THROW(renderPicture(ball, optionsFor(Shading::Flat, 1000000, 10)), std::runtime_error);
}

TEST(Picture, ShadingNamesAreThoseOfTheEnumeration)
{
  EXPECT_EQ(shadingByName("normals"), Shading::Normals);
  EXPECT_EQ(shadingByName("points"), Shading::PointCloud);
  for (std::size_t i = 0; i < shadingNames().size(); ++i)
    EXPECT_EQ(static_cast<std::size_t>(shadingByName(shadingNames()[i])), i);
}
} // namespace
} // namespace fresco
