// SPDX-License-Identifier: BSD-3-Clause
#include "stages/free_space.h"
#include <cmath>
#include <gtest/gtest.h>
#include <set>
namespace {
using namespace fresco;
using namespace fresco::model;

constexpr CameraModel camera{160, 120, 146.25, 146.25, 80.5, 60.5, 0, 0, 0, 0};

Image16 wallAt(double metres)
{
  Image16 image{camera.width, camera.height, {}};
  image.data.assign(160 * 120, static_cast<std::uint16_t>(std::lround(1000 * metres)));
  return image;
}

Points places()
{
  Points p(3, 5);
  p << 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 1, 2, 3, -1, 1; // before, on and behind the wall, behind the camera, out of view
  return p;
}

TEST(FreeSpace, BeforeADepthImageOnly)
{
  FreeSpace space(places(), 0.02, 2);
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  space.ask(wallAt(2.0), camera, here);
  EXPECT_EQ(space.empty(1), (std::vector<char>{1, 0, 0, 0, 0}));
  EXPECT_EQ(space.empty(2), (std::vector<char>{0, 0, 0, 0, 0}));
  space.ask(wallAt(0), camera, here); // nothing measured: nothing learned
  EXPECT_EQ(space.empty(2), (std::vector<char>{0, 0, 0, 0, 0}));
  space.ask(wallAt(1.0), camera, here); // now something stands there
  EXPECT_EQ(space.empty(1), (std::vector<char>{0, 0, 0, 0, 0}));
}

TEST(FreeSpace, APoseMovesTheView)
{
  FreeSpace space(places(), 0.02, 1);
  space.ask(wallAt(2.0), camera, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.5)));
  EXPECT_EQ(space.empty(1), (std::vector<char>{0, 1, 1, 0, 0}));
}

TEST(FreeSpace, AThingBesideTheBeamKeepsItsSurroundings)
{
  Image16 image = wallAt(2.0);
  for (int y = 0; y < image.height; ++y)
    image.data[y * image.width + 82] = 1000; // a thin pole two pixels beside the middle
  FreeSpace space(places(), 0.02, 1);
  space.ask(image, camera, Eigen::Isometry3d::Identity());
  EXPECT_EQ(space.empty(1)[0], 0);
}

/// Beams of a scanner in the middle of a ball of 2 m, with a window (no echo) towards +x.
Points ballScan()
{
  Points scan(3, 20000);
  for (Index i = 0; i < scan.cols(); ++i) {
    const double z = 1 - 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(scan.cols());
    const double angle = static_cast<double>(i) * 2.399963229728653, r = std::sqrt(1 - z * z);
    scan.col(i) = 2.f * Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
    if (scan(0, i) > 1.8f)
      scan.col(i).setConstant(std::numeric_limits<float>::quiet_NaN());
  }
  return scan;
}

TEST(FreeSpace, InsideOfALaserScanOnly)
{
  Points p(3, 5);
  p << 0, 0, 0, 1, -1, 0, 1, 0, 0, 0, 1, 0, 2.1f, 0, 0;
  p.col(1) *= 2.f; // on the ball
  FreeSpace space(p, 0.02, 1);
  space.ask(ballScan(), Eigen::Isometry3d::Identity());
  EXPECT_EQ(space.empty(1), (std::vector<char>{1, 0, 0, 0, 1})); // the window says nothing
  FreeSpace moved(p, 0.02, 4);
  moved.ask(ballScan(), Eigen::Isometry3d(Eigen::Translation3d(5, 0, 0)));
  EXPECT_EQ(moved.empty(1), (std::vector<char>(5, 0)));
}

/// Square grid of 21x21 vertices; vertex of row y and column x: 21 y + x.
TriangleMesh grid()
{
  TriangleMesh mesh;
  mesh.vertices.resize(3, 21 * 21);
  mesh.faces.resize(3, 2 * 20 * 20);
  Index face = 0;
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 21; ++x) {
      const int v = 21 * y + x;
      mesh.vertices.col(v) = Eigen::Vector3i(x, y, 0).cast<float>();
      if (x < 20 && y < 20) {
        mesh.faces.col(face++) << v, v + 1, v + 22;
        mesh.faces.col(face++) << v, v + 22, v + 21;
      }
    }
  mesh.fields["support"] = mesh.vertices.row(0).transpose();
  return mesh;
}

TEST(FreeSpace, SpecksStayAndPartsGo)
{
  const TriangleMesh mesh = grid();
  std::vector<char> removed(21 * 21, 0);
  EXPECT_EQ(withoutVertices(mesh, removed).faceCount(), mesh.faceCount());
  removed[10 * 21 + 5] = 1;
  EXPECT_EQ(withoutVertices(mesh, removed).faceCount(), mesh.faceCount());
  for (int y = 0; y < 21; ++y)
    for (int x = 11; x < 21; ++x)
      removed[21 * y + x] = 1;
  removed[10 * 21 + 15] = 0; // an island
  const TriangleMesh half = withoutVertices(mesh, removed);
  EXPECT_GT(half.vertices.row(0).maxCoeff(), 10.f);
  EXPECT_LT(half.vertices.row(0).maxCoeff(), 12.f); // at the corners; 10.5 elsewhere
  EXPECT_EQ(half.fields.at("support"), half.vertices.row(0).transpose());
  EXPECT_THROW(withoutVertices(mesh, {}), std::invalid_argument);
}

TEST(FreeSpace, BordersHaveNoTeeth)
{
  const TriangleMesh mesh = grid();
  std::vector<char> removed(21 * 21, 0);
  for (int y = 0; y < 21; ++y)
    for (int x = 10 + y / 2 % 2; x < 21; ++x)
      removed[21 * y + x] = 1;
  const TriangleMesh half = withoutVertices(mesh, removed);
  std::set<std::pair<int, int>> directed;
  for (Index f = 0; f < half.faceCount(); ++f)
    for (int k = 0; k < 3; ++k)
      directed.insert({half.faces(k, f), half.faces((k + 1) % 3, f)});
  double length = 0;
  for (const auto& [a, b] : directed)
    if (half.vertices(0, a) > 8 && half.vertices(0, b) > 8 && half.vertices(1, a) > 2 && half.vertices(1, a) < 18 &&
        directed.count({b, a}) == 0)
      length += (half.vertices.col(a) - half.vertices.col(b)).norm();
  EXPECT_LT(length, 16 * 1.15); // along the faces' own edges it is 24
}
} // namespace
