// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fresco/deliverables/core/crop_region.h>
#include <gtest/gtest.h>
#include <limits>
#include <random>
namespace {
using namespace fresco;

Eigen::Matrix2Xd outline(std::initializer_list<Eigen::Vector2d> points)
{
  Eigen::Matrix2Xd matrix(2, points.size());
  Eigen::Index k = 0;
  for (const Eigen::Vector2d& point : points)
    matrix.col(k++) = point;
  return matrix;
}

const Eigen::Matrix2Xd square = outline({{0, 0}, {4, 0}, {4, 4}, {0, 4}});

TEST(CropRegion, ShareOfPointsInsideIsTheArea)
{
  CropRegion region;
  region.outlines = {outline({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}}),
                     outline({{1, 0.5}, {1, 0.9}, {3, 0.9}, {3, 0.5}})};
  const double area = 16 - 6 - 2 * 0.4; // a square without a notch and without a hole
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(0, 4);
  const int samples = 200000;
  int inside = 0;
  for (int i = 0; i < samples; ++i)
    inside += isInside(region, {side(random), side(random), 7});
  const double share = area / 16, deviation = std::sqrt(share * (1 - share) / samples);
  EXPECT_NEAR(double(inside) / samples, share, 4 * deviation);
}

TEST(CropRegion, HeightsBoundIt)
{
  CropRegion region{{square}, -1, 2};
  EXPECT_TRUE(isInside(region, {1, 1, 0}));
  EXPECT_FALSE(isInside(region, {1, 1, 2.1}));
  EXPECT_FALSE(isInside(region, {1, 1, -1.1}));
  EXPECT_FALSE(isInside(region, {1, 1, std::nan("")}));
  EXPECT_TRUE(isInside(CropRegion{{}, -1, 2}, {1e6, -1e6, 0}));
}

TEST(CropRegion, RefusesWhatIsNoRegion)
{
  EXPECT_NO_THROW(validateCropRegion({{square}, 0, 1}));
  EXPECT_NO_THROW(validateCropRegion({{square, outline({{1, 1}, {2, 1}, {1, 2}})}, 0, 1}));
  const auto refused = [](const CropRegion& region) {
    EXPECT_THROW(validateCropRegion(region), std::invalid_argument);
  };
  refused({{}, 1, 1});
  refused({{}, std::nan(""), 1});
  refused({{outline({{0, 0}, {1, 0}})}, 0, 1});
  refused({{outline({{0, 0}, {1, 0}, {1, std::numeric_limits<double>::infinity()}})}, 0, 1});
  refused({{outline({{0, 0}, {4, 4}, {4, 0}, {0, 4}})}, 0, 1});         // a bow tie
  refused({{outline({{0, 0}, {4, 0}, {2, 0}})}, 0, 1});                 // no area
  refused({{outline({{0, 0}, {0, 0}, {4, 0}, {4, 4}})}, 0, 1});         // a point twice
  refused({{square, outline({{3, 3}, {5, 3}, {5, 5}, {3, 5}})}, 0, 1}); // two that overlap
  refused({{square, outline({{1, 0}, {2, 1}, {1, 1}})}, 0, 1});         // one that touches the other
}
} // namespace
