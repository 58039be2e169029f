// SPDX-License-Identifier: BSD-3-Clause
#include "filters/clouds.h"
#include "mixed_pixels/mixed_pixel_candidates.h"
#include "mixed_pixels/mixed_pixel_score.h"
#include <algorithm>
#include <map>
#include <numeric>
using namespace fresco::filters;
namespace fresco {
namespace {
using Eigen::Vector3f;

/// A wall at 4 m and a board at 3 m before it, at whose border ranges mix, seen by beams in no order: 2,500 of them are
/// 4 mrad apart.
Points boardBeforeWall(float deviation, Index beams = 2500)
{
  std::mt19937 generator(1);
  std::normal_distribution<float> noise(0, deviation);
  std::uniform_real_distribution<float> uniform(-0.1f, 0.1f);
  Points points(3, beams);
  for (Index i = 0; i < points.cols(); ++i) {
    const float y = uniform(generator), z = uniform(generator);
    const float on_board = std::clamp(0.5f + (y + 0.35f * z) / 0.004f, 0.f, 1.f);
    points.col(i) = Vector3f(1, y, z) * (4 - on_board + noise(generator));
  }
  return points;
}

BeamScan scanOf(const Points& points, const Vector3f& viewpoint)
{
  std::vector<Index> columns(points.cols());
  std::iota(columns.begin(), columns.end(), 0);
  BeamScan scan = makeBeamScan(points, viewpoint, columns, {});
  scan.noise = measureNoise(scan, 0);
  return scan;
}

std::map<Index, MixedPixelFeatures> candidatesOf(const BeamScan& scan)
{
  std::map<Index, MixedPixelFeatures> found;
  MixedPixelOptions options;
  options.threads = 1;
  forMixedPixelCandidates(scan, options, [&](Index i, const BeamSurroundings& around) {
    found[scan.columns[i]] = mixedPixelFeatures(around);
  });
  return found;
}

std::map<Index, SecondStageFeatures> secondStageOf(const BeamScan& scan, float score)
{
  std::map<Index, SecondStageFeatures> found;
  MixedPixelOptions options;
  options.threads = 1;
  const std::vector<float> scores(scan.columns.size(), score);
  forSecondStage(scan, options, scores,
                 [&](Index i, const SecondStageFeatures& features) { found[scan.columns[i]] = features; });
  return found;
}

/// That features of the board are finite and nearly all the same after a motion and in another unit: some beams lie as
/// near to one beam as to another, or at a threshold.
/// @param featuresOf scan -> features by column
template <typename FeaturesOf>
void expectSameAfterMotion(const FeaturesOf& featuresOf, double share)
{
  const Points points = boardBeforeWall(0.002f);
  const Eigen::Isometry3f motion = test::someMotion();
  const Points moved = 1000 * ((motion.linear() * points).colwise() + motion.translation());
  const auto here = featuresOf(scanOf(points, Vector3f::Zero()));
  const auto there = featuresOf(scanOf(moved, 1000 * motion.translation()));
  EXPECT_GT(here.size(), 30u);
  std::size_t same = 0;
  for (const auto& [column, features] : here) {
    EXPECT_TRUE(features.allFinite());
    const auto found = there.find(column);
    same += found != there.end() && (found->second - features).cwiseAbs().maxCoeff() < 0.05f;
  }
  EXPECT_GE(static_cast<double>(same), share * static_cast<double>(here.size()));
}

TEST(MixedPixelFeatures, ChangeNeitherWithTheFrameNorTheUnit)
{
  expectSameAfterMotion(candidatesOf, 0.95);
  expectSameAfterMotion([](const BeamScan& scan) { return secondStageOf(scan, 1); }, 0.9);
}

TEST(MixedPixelFeatures, TellHowManyNeighborsAreMixed)
{
  const BeamScan scan = scanOf(boardBeforeWall(0.002f), Vector3f::Zero());
  const auto widthAt = [&](float score) { return secondStageOf(scan, score).begin()->second.tail<2>().eval(); };
  EXPECT_EQ(widthAt(-1), Eigen::Vector2f(2, 2)); // nothing is taken for a mixed pixel: as usual
  EXPECT_EQ(widthAt(-2), widthAt(-1));
  EXPECT_GT(widthAt(1).minCoeff(), 7); // everything is: all 8 around
}

TEST(BeamScan, ListsTheNearestOfSomeBeams)
{
  const BeamScan scan = scanOf(boardBeforeWall(0.002f, 40000), Vector3f::Zero());
  ASSERT_TRUE(scan.thinned);
  const int k = MixedPixelOptions().k;
  int m = 0;
  for (Index i = 0; i < scan.directions.cols(); ++i)
    for (const int* j = scan.lists.first(i) + 1; j != scan.lists.last(i); ++j)
      m = std::gcd(m, *j);
  EXPECT_GT(m, 1);
  constexpr float least = 0.0015f; // radians
  for (Index i = 0; i < scan.directions.cols(); i += 97) {
    std::vector<float> expected, found;
    for (Index j = 0; j < scan.directions.cols(); j += m)
      expected.push_back((scan.directions.col(j) - scan.directions.col(i)).norm());
    expected.erase(std::remove_if(expected.begin(), expected.end(), [](float d) { return d <= least; }),
                   expected.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(*scan.lists.first(i), i);
    for (const int* j = scan.lists.first(i) + 1; j != scan.lists.last(i); ++j)
      found.push_back((scan.directions.col(*j) - scan.directions.col(i)).norm());
    ASSERT_EQ(static_cast<int>(found.size()), k);
    for (int n = 0; n < k; ++n)
      EXPECT_NEAR(found[n], expected[n], 1e-6f);
  }
}

TEST(MixedPixelFeatures, OfTheSecondStageAreTheSameWhereNothingIsLeftOut)
{
  using mixed_pixel_features::bearings, mixed_pixel_features::of_rings;
  for (const Index beams : {2500, 40000}) {
    const BeamScan scan = scanOf(boardBeforeWall(0.002f, beams), Vector3f::Zero());
    EXPECT_EQ(scan.thinned, beams == 40000);
    const auto first = candidatesOf(scan);
    const auto second = secondStageOf(scan, -1);
    ASSERT_EQ(first.size(), second.size());
    for (const auto& [column, features] : second) {
      EXPECT_EQ(features.head<mixed_pixel_features::count>(), first.at(column));
      EXPECT_EQ(features.segment<mixed_pixel_features::count>(mixed_pixel_features::count), first.at(column));
      EXPECT_TRUE((features.segment<2 * bearings + 1>(2 * mixed_pixel_features::count).array() == -1).all());
      EXPECT_TRUE((features.tail<of_rings / 2 + 2>().head<of_rings / 2>().array() == -1).all());
    }
    EXPECT_TRUE(secondStageOf(scan, least_second_stage).empty());
  }
}

TEST(MixedPixelFeatures, AreFiniteAndScoredWhateverTheBeamsAre)
{
  BeamWindow window;
  window.range = 2;
  window.spacing = 1e-6f;
  for (int k = 0; k < 8; ++k)
    window.beams.push_back({{0, 0}, {0, 0}, 1, k % 2 == 0 ? 1e-9f : 1e9f, k, 0});
  BeamWindow one = window;
  one.beams.resize(1);
  for (const BeamWindow* wide : {&window, &one})
    for (const float noise : {1e-9f, 1.f, 1e9f}) {
      const BeamSurroundings around{window, *wide, noise};
      const MixedPixelFeatures features = mixedPixelFeatures(around);
      EXPECT_TRUE(features.allFinite());
      EXPECT_TRUE(std::isfinite(mixedPixelScore(features)));
      EXPECT_TRUE(
          (scoresAround(around, std::vector<float>(8, -100)).array() == mixed_pixel_features::least_score).all());
    }
}

TEST(RangeNoise, IsMeasuredByRangeAndJoinedInBetween)
{
  const RangeNoise noise{{1, 3}, {0.1f, 0.3f}};
  EXPECT_FLOAT_EQ(noise.at(0), 0.1f);
  EXPECT_FLOAT_EQ(noise.at(2), 0.2f);
  EXPECT_FLOAT_EQ(noise.at(9), 0.3f);
  std::mt19937 generator(1);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform(-0.5f, 0.5f);
  Points points(3, 20000);
  for (Index i = 0; i < points.cols(); ++i) {
    const float y = uniform(generator), range = y > 0 ? 2 + 0.002f * normal(generator) : 6 + 0.006f * normal(generator);
    points.col(i) = Vector3f(1, y, uniform(generator)).normalized() * range;
  }
  const RangeNoise measured = scanOf(points, Vector3f::Zero()).noise;
  EXPECT_NEAR(measured.at(2), 0.002f, 0.0003f);
  EXPECT_NEAR(measured.at(6), 0.006f, 0.0009f);
}
} // namespace
} // namespace fresco
