// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/exact_sum.h"
#include "poisson/samples/occupied_cells.h"
#include "poisson/samples/point_sketch.h"
#include "surface/poisson/volumetric_shapes.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <numeric>
#include <random>
namespace fresco::test {
namespace {
/// A cloud in windows of at most `window` points, in any order.
class Windows : public PointStream {
public:
  Windows(const PointSet& set, Index window, unsigned seed) : set_(set), window_(window), order_(set.size())
  {
    std::iota(order_.begin(), order_.end(), 0);
    std::shuffle(order_.begin(), order_.end(), std::mt19937(seed));
  }

  void read(const std::function<void(const PointSet&)>& receive) const override
  {
    for (auto begin = order_.begin(); begin != order_.end();) {
      const auto end = begin + std::min<Index>(window_, order_.end() - begin);
      receive(selectPoints(set_, std::vector<Index>(begin, end)));
      begin = end;
    }
  }

private:
  const PointSet& set_;
  Index window_;
  std::vector<Index> order_;
};

/// Points of unlike weight with all attributes, far outliers, and some that cannot be used.
PointSet variedPoints()
{
  PointSet set = torus(30000, 0.3, 7);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  set.points += Points::NullaryExpr(3, set.size(), [&] { return 0.02f * unit(random); });
  set.colors = (set.normals.array() * 127.f + 128.f).cast<std::uint8_t>();
  set.intensities = Eigen::VectorXf::NullaryExpr(set.size(), [&] { return 4000.f * unit(random) - 900.f; });
  set.confidences = Eigen::VectorXf::NullaryExpr(set.size(), [&] { return std::exp(20.f * unit(random)); });
  set.points.leftCols(5) *= 1000.f;
  set.points(1, 100) = std::numeric_limits<float>::quiet_NaN();
  set.normals.col(200).setZero();
  set.confidences[300] = std::numeric_limits<float>::infinity();
  set.intensities[400] = std::numeric_limits<float>::quiet_NaN();
  return set;
}

void expectSame(const VolumetricResult& a, const VolumetricResult& b)
{
  EXPECT_EQ(a.used_points, b.used_points);
  EXPECT_EQ(a.left_out_points, b.left_out_points);
  EXPECT_EQ(a.residual, b.residual);
  EXPECT_EQ(a.cell_size, b.cell_size);
  EXPECT_EQ(a.mesh.origin, b.mesh.origin);
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.faces, b.mesh.faces);
  EXPECT_EQ(a.mesh.colors, b.mesh.colors);
  EXPECT_EQ(a.mesh.fields.at("support"), b.mesh.fields.at("support"));
  EXPECT_EQ(a.mesh.fields.at("intensity"), b.mesh.fields.at("intensity"));
}

TEST(VolumetricStream, OrderAndWindowsOfThePointsDoNotChangeABit)
{
  const PointSet points = variedPoints();
  VolumetricOptions options = atDepth(7);
  options.confidence = true;
  const VolumetricResult expected = reconstructVolumetric(points, options);
  EXPECT_EQ(expected.left_out_points, 8); // five outliers, no place, no normal, no weight
  EXPECT_TRUE(expected.mesh.fields.at("intensity").allFinite());
  for (const Index window : {100000, 7777, 512}) {
    options.threads = 1 + static_cast<int>(window % 3);
    expectSame(reconstructVolumetric(std::make_unique<Windows>(points, window, window), options), expected);
    EXPECT_EQ(estimateMemory(Windows(points, window, 1), options), estimateMemory(points, options));
  }
}

TEST(VolumetricStream, OutliersOfALargeCloudDoNotDependOnTheOrder)
{
  PointSet points = sphere(400000); // more than the sample that tells outliers
  points.points.leftCols(100) *= 50.f;
  VolumetricOptions options = atDepth(4);
  const poisson::Extent a = poisson::findExtent(Windows(points, 1000000, 1), options),
                        b = poisson::findExtent(Windows(points, 30000, 2), options);
  EXPECT_EQ(a.usable, 399900);
  EXPECT_EQ(b.usable, a.usable);
  EXPECT_EQ(b.cube.corner, a.cube.corner);
  EXPECT_EQ(b.cube.side, a.cube.side);
}

TEST(VolumetricStream, StreamsWithoutUsablePointsAreRefused)
{
  const PointSet none;
  EXPECT_THROW(reconstructVolumetric(std::make_unique<Windows>(none, 10, 1), atDepth(4)), std::invalid_argument);
  PointSet points = sphere(100);
  points.normals.resize(3, 0);
  EXPECT_THROW(reconstructVolumetric(std::make_unique<Windows>(points, 10, 1), atDepth(4)), std::invalid_argument);
}

TEST(VolumetricStream, ExactSumsDoNotDependOnTheOrder)
{
  std::mt19937 random(5);
  std::vector<float> values;
  for (int exponent = -149; exponent < 127; ++exponent)
    for (int i = 0; i < 20; ++i)
      values.push_back(std::ldexp(1.f + static_cast<float>(random() & 0xffff), exponent - 16));
  const auto sum = [&] {
    poisson::ExactSum first, second;
    for (std::size_t i = 0; i < values.size(); ++i)
      (i % 3 == 0 ? first : second).add(values[i]);
    first.add(second);
    return first.value();
  };
  const double expected = sum();
  std::shuffle(values.begin(), values.end(), random);
  EXPECT_EQ(sum(), expected);
  poisson::ExactSum small;
  for (int i = 0; i < 1000; ++i)
    small.add(1.f + std::ldexp(1.f, -20));
  small.add(1e30f);
  small.add(-1e30f);
  EXPECT_EQ(small.value(), 1000 + std::ldexp(1000.0, -20));
}

TEST(VolumetricStream, UnitedBricksHaveTheCellsOfBoth)
{
  std::mt19937_64 random(6);
  for (const int size : {0, 1, 5000}) {
    std::map<std::uint64_t, std::uint64_t> lists[2], expected;
    Array<poisson::OccupiedBrick> bricks[2];
    for (int list = 0; list < 2; ++list) {
      for (int i = 0; i < size * (list + 1); ++i)
        lists[list][random() % 20000] = random();
      for (const auto& [code, cells] : lists[list]) {
        bricks[list].push_back({code, cells});
        expected[code] |= cells;
      }
    }
    const Array<poisson::OccupiedBrick> united = poisson::unite(bricks[0], bricks[1], 2);
    ASSERT_EQ(united.size(), expected.size());
    auto brick = united.begin();
    for (const auto& [code, cells] : expected) {
      EXPECT_EQ(brick->code, code);
      EXPECT_EQ((brick++)->cells, cells);
    }
  }
}
} // namespace
} // namespace fresco::test
