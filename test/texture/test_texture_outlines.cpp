// SPDX-License-Identifier: BSD-3-Clause
#include "texture/texture_scene.h"
#include "views/outline_mask.h"
#include <gtest/gtest.h>
using namespace fresco::texture;
namespace fresco::test {
namespace {
/// @param depth of the cell (x, y)
DepthMap mapOf(const std::function<float(int, int)>& depth)
{
  DepthMap map;
  map.width = 40;
  map.height = 30;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      map.depth.push_back(depth(x, y));
  return map;
}

const Eigen::Vector2f everything[2] = {{0, 0}, {40, 30}};
constexpr float reach = 2, step = 0.02f;
} // namespace

TEST(TextureOutlines, PlanesAndTheirBendsAreNone)
{
  for (const float slope : {0.f, 0.002f, 0.008f}) { // of the inverse depth: at 0.008 a cell is 3 to 10 cm deep
    const OutlineMask plane(mapOf([&](int x, int) { return 1 / (0.3f + slope * static_cast<float>(x)); }), reach, step);
    EXPECT_FALSE(plane.touches(everything[0], everything[1])) << slope;
    const OutlineMask bend(mapOf([&](int x, int) { return 1 / (0.3f + slope * static_cast<float>(std::min(x, 20))); }),
                           reach, step);
    EXPECT_FALSE(bend.touches(everything[0], everything[1])) << slope;
  }
}

TEST(TextureOutlines, WhatLiesBehindOneIsHeldWithinReachOfIt)
{
  const OutlineMask mask(mapOf([](int x, int) { return x < 20 ? 1.f : 2.f; }), reach, step);
  for (float x = 0.5f; x < 40; ++x) {
    const float away = std::abs(x - 20);
    const bool near = away<reach, far = away> reach + 2;
    EXPECT_FALSE(mask.holds({x, 15}, 1.f)) << x << ": the nearer surface";
    if (near || far) {
      EXPECT_EQ(mask.holds({x, 15}, 0.5f), near) << x;
    }
  }
}

TEST(TextureOutlines, ThingsOneCellWideHaveThem)
{
  const OutlineMask mask(mapOf([](int x, int) { return x == 20 ? 1.f : 2.f; }), reach, step);
  for (const float x : {19.5f, 20.5f, 21.5f}) {
    EXPECT_TRUE(mask.holds({x, 15}, 0.5f)) << x;
    EXPECT_FALSE(mask.holds({x, 15}, 1.f)) << x;
  }
}

TEST(TextureOutlines, NothingOfWhatStandsBeforeItIsPaintedOnASurface)
{
  TriangleMesh mesh;
  appendBox({-1, -1, -0.2f}, {1, 1, 0}, false, mesh);
  appendBox({-0.43f, -0.37f, 0.3f}, {0.41f, 0.39f, 0.35f}, false, mesh);
  const Pattern pattern = [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const double wave = std::sin(60 * p.x() + 7 * p.y()) + std::sin(9 * p.x() - 55 * p.y()) +
                        std::sin(4 * p.x() + 3 * p.y()); // for the cameras to be compared by
    return p.z() > 0.1 ? Eigen::Vector3d(230, 60 + 20 * wave, 60) : Eigen::Vector3d(20, 120 + 40 * wave, 120);
  };
  std::vector<TextureView> views;
  for (const double x : {-0.9, 0.0, 0.9})
    for (const double y : {-0.8, 0.8})
      views.push_back(photograph(mesh, pattern, camera(400, 400, 480), lookAt({x, y, 3}, {0, 0, 0})));
  const TextureResult result = reconstructTexture(mesh, views, withThreads(0));
  ASSERT_GT(result.disagreement_before, 0);
  ASSERT_LT(result.disagreement_after, 0.5);
  int red = 0, count = 0;
  forPlaces(result.model.mesh, 20000, [&](Index f, const Eigen::Vector3d& weights) {
    if (f >= 12)
      return; // the board
    red += colorAt(result.model, f, weights).x() > 90;
    ++count;
  });
  EXPECT_LE(red, count / 100000) << "of " << count; // a texel at the end of what is seen may be a mixture
}
} // namespace fresco::test
