// SPDX-License-Identifier: BSD-3-Clause
#include "filters/clouds.h"
#include "normals/exponential.h"
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/local_sampling.h>
#include <fresco/filters/core/oriented_normals.h>
using namespace fresco::filters;
namespace fresco {
namespace {
using test::Cloud;
using test::nan;

Points noisyNormals(const Points& normals, float deviation, unsigned seed)
{
  return test::withNoise(normals, deviation, seed).colwise().normalized();
}

BilateralOptions withRounds(int rounds)
{
  BilateralOptions options;
  options.rounds = rounds;
  return options;
}

/// One round of the equation, literally, in double precision.
Points oneRound(const Points& points, const Points& normals, double sigma_d, double sigma_n)
{
  const PointTree tree(points);
  const Eigen::VectorXf by_position = sampleAreas(tree);
  Eigen::VectorXd areas(points.cols());
  for (Index i = 0; i < points.cols(); ++i)
    areas[tree.columns()[i]] = by_position[i];
  const double s_n = 1 - std::cos(sigma_n * M_PI / 180);
  Points result(3, points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Index j = 0; j < points.cols(); ++j) {
      const double distance = (points.col(i) - points.col(j)).cast<double>().norm();
      if (distance > 2 * sigma_d)
        continue;
      const double difference = 1 - normals.col(i).cast<double>().dot(normals.col(j).cast<double>());
      sum += areas[j] * std::exp(-distance * distance / (2 * sigma_d * sigma_d)) *
             std::exp(-difference * difference / (2 * s_n * s_n)) * normals.col(j).cast<double>();
    }
    result.col(i) = sum.normalized().cast<float>();
  }
  return result;
}

TEST(BilateralNormals, FollowTheEquation)
{
  const Cloud cube = test::cube(600, 1);
  const Points normals = noisyNormals(cube.normals, 0.2f, 2);
  BilateralOptions options = withRounds(1);
  options.sigma_d = 0.2f;
  options.sigma_n = 25;
  const Points once = oneRound(cube.points, normals, 0.2f, 25);
  EXPECT_LT((smoothNormals(cube.points, normals, options).normals - once).cwiseAbs().maxCoeff(), 2e-5f);
  options.rounds = 2;
  const Points twice = oneRound(cube.points, once, 0.2f, 25);
  EXPECT_LT((smoothNormals(cube.points, normals, options).normals - twice).cwiseAbs().maxCoeff(), 4e-5f);
}

TEST(BilateralNormals, RoundZeroIsTheInput)
{
  const Cloud cube = test::cube(100, 1);
  const BilateralResult result = smoothNormals(cube.points, 3 * cube.normals, withRounds(0));
  EXPECT_TRUE(test::same(result.normals, Points(3 * cube.normals)));
  EXPECT_TRUE(test::same(result.points, cube.points));
}

TEST(BilateralNormals, TakeNoiseOffFacesAndKeepTheCrease)
{
  const Cloud cube = test::cube(30000, 4);
  PointSet set;
  set.points = test::withNoise(cube.points, 0.003f, 5);
  set.viewpoints = 3 * cube.points;
  const Points raw = estimateNormals(set).normals;
  const auto errors = [&](const Points& normals, bool faces) {
    double sum = 0;
    Index count = 0;
    for (Index i = 0; i < normals.cols(); ++i)
      if ((test::edgeDistance(cube.points.col(i)) > 0.1f) == faces) {
        sum += test::angleBetween(normals.col(i), cube.normals.col(i));
        ++count;
      }
    return sum / static_cast<double>(count);
  };
  double before = errors(raw, true);
  const double start = before;
  for (const int rounds : {1, 3, 5}) {
    const Points smooth = smoothNormals(set.points, raw, withRounds(rounds)).normals;
    EXPECT_LT(errors(smooth, true), before) << rounds;
    EXPECT_LT(errors(smooth, false), 1.02 * errors(raw, false)) << rounds;
    before = errors(smooth, true);
  }
  EXPECT_LT(before, 0.35 * start);
}

TEST(BilateralNormals, TwoFacesWithExactNormalsStayExact)
{
  const Cloud cube = test::cube(3000, 4);
  EXPECT_LT(test::meanAngle(smoothNormals(cube.points, cube.normals, withRounds(5)).normals, cube.normals), 0.01);
}

/// Normals that turn along x, sampled eight times denser on one half: the mean at the border must not lean to it.
TEST(BilateralNormals, DensityDoesNotBiasTheMean)
{
  const Points grid = test::randomPoints(40000, 6);
  std::vector<Index> kept;
  for (Index i = 0; i < grid.cols(); ++i)
    if (grid(0, i) > 0 || i % 8 == 0)
      kept.push_back(i);
  Points points(3, static_cast<Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i)
    points.col(static_cast<Index>(i)) << grid(0, kept[i]), grid(1, kept[i]), 0.f;
  Points normals(3, points.cols());
  for (Index i = 0; i < points.cols(); ++i)
    normals.col(i) << std::sin(0.4f * points(0, i)), 0, std::cos(0.4f * points(0, i));
  BilateralOptions options = withRounds(1);
  options.sigma_d = 0.1f;
  options.sigma_n = 90;
  const Points smooth = smoothNormals(points, normals, options).normals;
  double lean = 0, unweighted = 0, weight = 0;
  Index count = 0;
  for (Index i = 0; i < points.cols(); ++i)
    if (std::abs(points(0, i)) < 0.01f && std::abs(points(1, i)) < 0.7f) {
      lean += std::asin(smooth(0, i)) / 0.4 - points(0, i);
      ++count;
      for (Index j = 0; j < points.cols(); ++j)
        if ((points.col(j) - points.col(i)).norm() < 0.2f) {
          const double w = std::exp(-(points.col(j) - points.col(i)).squaredNorm() / 0.02);
          unweighted += w * (points(0, j) - points(0, i));
          weight += w;
        }
    }
  EXPECT_LT(std::abs(lean / static_cast<double>(count)), 0.2 * std::abs(unweighted / weight));
}

TEST(BilateralNormals, MoveWithTheInput)
{
  const Cloud cube = test::cube(3000, 1);
  const Points normals = noisyNormals(cube.normals, 0.2f, 2);
  const Eigen::Isometry3f motion = test::someMotion();
  const Points moved = (motion.linear() * cube.points).colwise() + motion.translation();
  const Points a = smoothNormals(cube.points, normals).normals;
  const Points b = smoothNormals(moved, motion.linear() * normals).normals;
  EXPECT_LT(test::meanAngle(motion.linear() * a, b), 0.02);
}

TEST(BilateralNormals, DoNotDependOnThreadsOrOnTheOrderOfPoints)
{
  const Cloud cube = test::cube(20000, 1);
  const Points normals = noisyNormals(cube.normals, 0.2f, 2);
  BilateralOptions one = withRounds(3), four = one;
  one.move_rounds = four.move_rounds = 1;
  one.threads = 1;
  four.threads = 4;
  const BilateralResult a = smoothNormals(cube.points, normals, one), b = smoothNormals(cube.points, normals, four);
  EXPECT_TRUE(test::same(a.normals, b.normals));
  EXPECT_TRUE(test::same(a.points, b.points));
  const BilateralResult c = smoothNormals(cube.points.rowwise().reverse(), normals.rowwise().reverse(), one);
  EXPECT_LT(test::meanAngle(c.normals.rowwise().reverse(), a.normals), 0.01);
}

TEST(BilateralNormals, MovingTakesPointsToTheSurface)
{
  const Cloud ball = test::unitSphere(20000, 1);
  const Points noisy = test::withNoise(ball.points, 0.01f, 3);
  BilateralOptions options = withRounds(2);
  options.move_rounds = 3;
  const BilateralResult result = smoothNormals(noisy, noisyNormals(ball.normals, 0.05f, 4), options);
  const auto spread = [](const Points& p) {
    const Eigen::ArrayXf radii = p.colwise().norm().transpose();
    return std::sqrt((radii - 1).square().mean());
  };
  EXPECT_LT(spread(result.points), 0.7f * spread(noisy));
}

TEST(BilateralNormals, UnusablePointsNeitherChangeNorCount)
{
  const Cloud cube = test::cube(2000, 1);
  Points points = cube.points, normals = noisyNormals(cube.normals, 0.2f, 2);
  points.col(3).setConstant(nan);
  normals.col(4).setConstant(nan);
  normals.col(5).setZero();
  const BilateralResult all = smoothNormals(points, normals);
  EXPECT_TRUE(test::same(Points(all.normals.col(3)), Points(normals.col(3))));
  EXPECT_TRUE(all.normals.col(4).array().isNaN().all());
  EXPECT_EQ(all.normals.col(5), Eigen::Vector3f::Zero());
  const BilateralResult rest = smoothNormals(points.rightCols(1994), normals.rightCols(1994));
  const BilateralResult with = smoothNormals(points.rightCols(1997), normals.rightCols(1997));
  EXPECT_TRUE(test::same(Points(rest.normals), Points(with.normals.rightCols(1994))));
}

TEST(BilateralNormals, CoincidentSingleAndNoPoints)
{
  EXPECT_EQ(smoothNormals(Points(3, 0), Points(3, 0)).normals.cols(), 0);
  const Points up = Eigen::Vector3f::UnitZ().replicate(1, 100);
  EXPECT_LT(test::meanAngle(smoothNormals(Points::Zero(3, 100), up).normals, up), 1e-3);
  EXPECT_EQ(smoothNormals(Points::Zero(3, 1), 2 * up.col(0)).normals.col(0), Eigen::Vector3f::UnitZ());
}

TEST(BilateralNormals, RejectsWhatIsOutOfRange)
{
  const Cloud cube = test::cube(20, 1);
  EXPECT_THROW(smoothNormals(cube.points, cube.normals.leftCols(3)), std::invalid_argument);
  const auto rejects = [&](auto change) {
    BilateralOptions options;
    change(options);
    EXPECT_THROW(smoothNormals(cube.points, cube.normals, options), std::invalid_argument);
  };
  rejects([](BilateralOptions& o) { o.rounds = -1; });
  rejects([](BilateralOptions& o) { o.move_rounds = -1; });
  rejects([](BilateralOptions& o) { o.sigma_d = -1; });
  rejects([](BilateralOptions& o) { o.sigma_d = nan; });
  rejects([](BilateralOptions& o) { o.sigma_n = 0; });
  rejects([](BilateralOptions& o) { o.sigma_n = 181; });
  rejects([](BilateralOptions& o) { o.spacings = 0; });
  rejects([](BilateralOptions& o) { o.threads = -1; });
  EXPECT_THROW(smoothNormals(cube.points, cube.normals, {}, [](auto, double) { return false; }), Cancelled);
}

TEST(BilateralNormals, ExponentialIsExact)
{
  std::vector<float> values;
  for (float x = 0; x > -86; x -= 0.0137f)
    values.push_back(x);
  std::vector<float> results = values;
  exponential(results.data(), static_cast<Index>(results.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(results[i] / std::exp(static_cast<double>(values[i])), 1, 4e-7) << values[i];
  float far[2] = {-90, -std::numeric_limits<float>::infinity()};
  exponential(far, 2);
  EXPECT_EQ(far[0], 0);
  EXPECT_EQ(far[1], 0);
}
} // namespace
} // namespace fresco
