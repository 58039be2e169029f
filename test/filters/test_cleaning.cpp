// SPDX-License-Identifier: BSD-3-Clause
#include "filters/virtual_scan.h"
#include <algorithm>
#include <array>
#include <fresco/filters/core/mixed_pixels.h>
#include <fresco/filters/core/outliers.h>
#include <fresco/filters/core/voxel_thinning.h>
#include <fresco/io/point_io.h>
#include <map>
#include <numeric>
namespace fresco {
namespace {
using test::nan;

std::vector<Index> allIndices(Index n)
{
  std::vector<Index> indices(n);
  std::iota(indices.begin(), indices.end(), Index(0));
  return indices;
}

TEST(Outliers, LonePointsGoAndTheSurfaceStays)
{
  Points points = test::unitSphere(5000, 1).points;
  points.leftCols(5) = 2 + 3 * test::randomPoints(5, 3).array().abs();
  for (const bool relative : {false, true}) {
    OutlierOptions options;
    options.sigma = 5;
    options.relative = relative;
    const auto kept = withoutOutliers(points, options);
    EXPECT_GT(kept.size(), 4960u);
    EXPECT_GE(kept.front(), 5) << relative;
    options.threads = 3;
    EXPECT_EQ(withoutOutliers(points, options), kept);
  }
}

TEST(Outliers, RelativeJudgementKeepsTheSparseHalf)
{
  Points points = test::flatSquare(20000, 1).points;
  for (Index i = 0; i < 200; ++i)
    points(0, i) += 3; // a part that is a hundred times sparser
  OutlierOptions options;
  options.sigma = 3;
  const auto sparse = [](const std::vector<Index>& kept) {
    return std::count_if(kept.begin(), kept.end(), [](Index i) { return i < 200; });
  };
  EXPECT_LT(sparse(withoutOutliers(points, options)), 20);
  options.relative = true;
  EXPECT_GT(sparse(withoutOutliers(points, options)), 180);
}

TEST(Outliers, OddInput)
{
  EXPECT_TRUE(withoutOutliers(Points(3, 0)).empty());
  EXPECT_EQ(withoutOutliers(Points::Zero(3, 1)).size(), 1u);
  EXPECT_EQ(withoutOutliers(Points::Ones(3, 100)).size(), 100u);
  Points points = test::randomPoints(10, 1);
  points(1, 4) = nan;
  const auto kept = withoutOutliers(points); // k exceeds the number of points
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 4), 0);
  OutlierOptions options;
  options.k = 0;
  EXPECT_THROW(withoutOutliers(points, options), std::invalid_argument);
  options = {};
  options.sigma = nan;
  EXPECT_THROW(withoutOutliers(points, options), std::invalid_argument);
}

/// A square, beside it a part of it ten times sparser, a rod over it; then points all over their box.
Points scatteredOver(Index on_square, Index scattered)
{
  Points points = test::randomPoints(on_square + on_square / 10 + scattered, 1);
  points.row(2).head(on_square).setZero();
  points.row(0).head(on_square / 10).array() += 2; // the sparse part
  auto rod = points.middleCols(on_square, on_square / 10);
  rod.row(1).setConstant(0.3f);
  rod.row(2) = 0.5f + 0.2f * rod.row(0).array();
  points.rightCols(scattered).row(0) = points.rightCols(scattered).row(0).array() * 2 + 1;
  return points;
}

TEST(Scatter, GoesAndSparseSurfacesAndRodsStay)
{
  for (const Index scattered : {6000, 12000}) {
    const Points points = scatteredOver(60000, scattered);
    const Index surface = points.cols() - scattered;
    const auto kept = withoutScatter(points);
    const Index stay = std::lower_bound(kept.begin(), kept.end(), surface) - kept.begin();
    EXPECT_GT(stay, 0.995 * surface) << scattered;
    EXPECT_LT(Index(kept.size()) - stay, 0.05 * scattered) << scattered;
    EXPECT_GT(std::lower_bound(kept.begin(), kept.end(), 6000) - kept.begin(), 5850) << "the sparse part";
  }
  const Points clean = scatteredOver(20000, 0);
  EXPECT_EQ(withoutScatter(clean).size(), std::size_t(clean.cols()));
}

TEST(Scatter, IsTheSameAtAnyScaleAndPlaceAndForAnyThreads)
{
  const Points points = scatteredOver(5000, 500);
  const auto kept = withoutScatter(points);
  ScatterOptions options;
  options.threads = 3;
  EXPECT_EQ(withoutScatter(points, options), kept);
  EXPECT_EQ(withoutScatter(1024 * points), kept);
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(1, Eigen::Vector3f(1, 2, 2) / 3).toRotationMatrix();
  std::vector<Index> apart;
  const auto moved = withoutScatter((turn * points).colwise() + Eigen::Vector3f(3, -2, 1));
  std::set_symmetric_difference(kept.begin(), kept.end(), moved.begin(), moved.end(), std::back_inserter(apart));
  EXPECT_LT(apart.size(), 10u) << "rounding";
  EXPECT_GT(options.dimension, 2);
  options.dimension = 1e9f; // nothing has it
  EXPECT_EQ(withoutScatter(points, options).size(), std::size_t(points.cols()));
}

TEST(Scatter, OddInput)
{
  EXPECT_TRUE(withoutScatter(Points(3, 0)).empty());
  for (const Index few : {1, 2, 17, 18, 40})
    EXPECT_EQ(withoutScatter(test::randomPoints(few, 1)).size(), std::size_t(few)) << "nothing is sparser than most";
  EXPECT_EQ(withoutScatter(Points::Ones(3, 100)).size(), 100u);
  const Points once = scatteredOver(5000, 500);
  Points twice(3, 2 * once.cols() + 1);
  twice << once, once, Eigen::Vector3f::Constant(nan);
  const auto kept = withoutScatter(twice);
  const Index half = std::lower_bound(kept.begin(), kept.end(), once.cols()) - kept.begin();
  EXPECT_EQ(Index(kept.size()), 2 * half) << "both of a pair or none";
  EXPECT_LT(half, once.cols() - 200);
  EXPECT_GT(half, once.cols() - 550);
  ScatterOptions options;
  options.k = 1;
  EXPECT_THROW(withoutScatter(once, options), std::invalid_argument);
  options = {};
  options.dimension = nan;
  EXPECT_THROW(withoutScatter(once, options), std::invalid_argument);
}

TEST(MixedPixels, GoAndLegsAndEdgesStay)
{
  const auto scan = test::scanWithMixedPixels(0.005f, 0.002f, 1);
  const auto kept = withoutMixedPixels(scan.points, Eigen::Vector3f::Zero());
  std::vector<bool> stays(scan.mixed.size(), false);
  for (const Index i : kept)
    stays[i] = true;
  Index mixed = 0, found = 0, wrong = 0, legs = 0, lost_legs = 0;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    mixed += scan.mixed[i];
    found += scan.mixed[i] && !stays[i];
    wrong += !scan.mixed[i] && !stays[i];
    legs += scan.leg[i];
    lost_legs += scan.leg[i] && !stays[i];
  }
  EXPECT_GT(mixed, 100);
  EXPECT_GT(found, 0.9 * mixed);
  EXPECT_LT(wrong, 0.05 * found);
  EXPECT_GT(legs, 100);
  EXPECT_EQ(lost_legs, 0);
}

TEST(MixedPixels, AreFoundWhereBeamsOverlap)
{
  std::mt19937 generator(1);
  std::normal_distribution<float> noise(0, 0.002f);
  for (const float step : {0.003f, 0.001f}) {
    std::vector<Eigen::Vector3f> points;
    std::vector<int> kinds; // 0 = a wall and a board in front of it, 1 = between them, 2 = a rod, 3 = a tenth mixed
    for (float azimuth = -0.1f; azimuth < 0.1f; azimuth += step)
      for (float elevation = -0.1f; elevation < 0.1f; elevation += step) {
        // beams are 4 mrad wide: where they meet the slanted border of the board, ranges mix
        const float on_board = std::clamp(0.5f + (azimuth + 0.35f * elevation) / 0.004f, 0.f, 1.f);
        const bool rod = std::abs(azimuth + 0.07f) < 0.0031f;
        const Eigen::Vector3f beam(1, std::tan(azimuth), std::tan(elevation));
        points.emplace_back(beam * ((rod ? 3.7f : 4 - 0.25f * on_board) + noise(generator)));
        const float mixed = std::min(on_board, 1 - on_board);
        kinds.push_back(rod ? 2 : mixed > 0.1f ? 1 : mixed > 0 ? 3 : 0);
      }
    Points cloud(3, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
      cloud.col(static_cast<Index>(i)) = points[i];
    Index kept[4] = {0, 0, 0, 0}, all[4] = {0, 0, 0, 0};
    for (const int kind : kinds)
      ++all[kind];
    for (const Index i : withoutMixedPixels(cloud, Eigen::Vector3f::Zero()))
      ++kept[kinds[i]];
    EXPECT_GT(all[1], 50);
    EXPECT_LT(static_cast<double>(kept[1]), 0.4 * static_cast<double>(all[1])) << step;
    EXPECT_LT(all[0] - kept[0], all[0] / 500) << step;
    EXPECT_EQ(kept[2], all[2]) << step;
  }
}

// Where a border crosses the rows of a scan at a small angle, the share of the board grows from beam to beam: the mixed
// is a ramp whose points have neighbours at 1.4 times the distance of the beams.
TEST(MixedPixels, RampsAlongObliqueBordersGo)
{
  std::mt19937 generator(1);
  std::normal_distribution<float> noise(0, 0.002f);
  constexpr float step = 0.004f;
  constexpr int steps = 19; // of 16 mm in depth, from the board to the wall
  std::vector<Eigen::Vector3f> points;
  std::vector<bool> ramp;
  for (int row = -30; row < 30; ++row)
    for (int column = -30; column < 30; ++column) {
      const int up = ((row % steps) + steps) % steps;
      const bool mixed = column == 0 && up > 1 && up < steps - 1;
      const float range = mixed ? 3.7f + 4 * step * static_cast<float>(up) : column < 0 ? 3.7f : 4.f;
      const Eigen::Vector3f beam(1, step * static_cast<float>(column), step * static_cast<float>(row));
      points.emplace_back(beam.normalized() * (range + noise(generator)));
      ramp.push_back(mixed && up >= 4 && up <= 15);
    }
  Points cloud(3, static_cast<Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    cloud.col(static_cast<Index>(i)) = points[i];
  const Index all = std::count(ramp.begin(), ramp.end(), true);
  Index kept = 0, others = 0;
  for (const Index i : withoutMixedPixels(cloud, Eigen::Vector3f::Zero()))
    ++(ramp[i] ? kept : others);
  EXPECT_GT(all, 30);
  EXPECT_LT(kept, all / 2);
  EXPECT_GT(others, cloud.cols() - all - 20);
}

TEST(MixedPixels, GrazingSurfacesStay)
{
  Points floor = 4 * test::flatSquare(40000, 5).points;
  floor.row(2).setConstant(-0.8f);
  Points noisy = floor;
  std::mt19937 generator(1);
  std::normal_distribution<float> normal(0, 0.002f);
  for (Index i = 0; i < noisy.cols(); ++i)
    noisy.col(i) *= 1 + normal(generator) / noisy.col(i).norm();
  EXPECT_GT(withoutMixedPixels(noisy, Eigen::Vector3f::Zero()).size(), 39960u);
}

TEST(MixedPixels, FollowMotionThreadsAndViewpoints)
{
  const auto scan = test::scanWithMixedPixels(0.01f, 0.002f, 1);
  const auto kept = withoutMixedPixels(scan.points, Eigen::Vector3f::Zero());
  MixedPixelOptions options;
  options.threads = 4;
  EXPECT_EQ(withoutMixedPixels(scan.points, Eigen::Vector3f::Zero(), options), kept);
  // Two scans from two places: each is judged by itself.
  const Index n = scan.points.cols();
  const Eigen::Isometry3f motion = test::someMotion();
  Points both(3, 2 * n), viewpoints = Points::Zero(3, 2 * n);
  both << scan.points, (motion.linear() * scan.points).colwise() + motion.translation();
  viewpoints.rightCols(n).colwise() = Eigen::Vector3f(motion.translation());
  const auto two = withoutMixedPixels(both, viewpoints);
  const auto first = std::count_if(two.begin(), two.end(), [n](Index i) { return i < n; });
  EXPECT_EQ(first, static_cast<std::ptrdiff_t>(kept.size()));
  EXPECT_NEAR(static_cast<double>(two.size()), 2.0 * static_cast<double>(kept.size()), 4);
}

TEST(MixedPixels, OddInput)
{
  const Points origin = Eigen::Vector3f::Zero();
  EXPECT_TRUE(withoutMixedPixels(Points(3, 0), origin).empty());
  EXPECT_EQ(withoutMixedPixels(Points::Zero(3, 300), origin).size(), 300u);
  EXPECT_EQ(withoutMixedPixels(Points::Ones(3, 300), origin).size(), 300u);
  Points points = test::randomPoints(300, 1);
  points(0, 7) = nan;
  const auto kept = withoutMixedPixels(points, points.cwiseAbs().array().isNaN().select(0, points)); // a viewpoint each
  EXPECT_EQ(kept.size(), 299u);
  EXPECT_THROW(withoutMixedPixels(points, Points(3, 0)), std::invalid_argument);
  EXPECT_THROW(withoutMixedPixels(points, Points::Constant(3, 1, nan)), std::invalid_argument);
  const auto rejects = [&](auto change) {
    MixedPixelOptions options;
    change(options);
    EXPECT_THROW(withoutMixedPixels(points, origin, options), std::invalid_argument);
  };
  rejects([](MixedPixelOptions& o) { o.angle = 0; });
  rejects([](MixedPixelOptions& o) { o.angle = 90; });
  rejects([](MixedPixelOptions& o) { o.noise = -1; });
  rejects([](MixedPixelOptions& o) { o.k = 7; });
  rejects([](MixedPixelOptions& o) { o.k = 65; });
}

TEST(VoxelThinning, OnePointPerCellTheNearestToTheCentroid)
{
  Points points = test::randomPoints(5000, 1);
  points.col(17).setConstant(nan);
  const float cell = 0.2f;
  const VoxelThinning thin = thinByVoxel(points, cell);
  Eigen::Vector3f low = Eigen::Vector3f::Constant(9);
  for (Index i = 0; i < points.cols(); ++i)
    if (i != 17)
      low = low.cwiseMin(points.col(i));
  const auto cellOf = [&](Index i) {
    const Eigen::Vector3i c = ((points.col(i) - low) / cell).array().floor().cast<int>();
    return std::array{c[0], c[1], c[2]};
  };
  std::map<std::array<int, 3>, std::vector<Index>> cells;
  for (const Index i : allIndices(points.cols()))
    if (i != 17)
      cells[cellOf(i)].push_back(i);
  ASSERT_EQ(thin.kept.size(), cells.size());
  EXPECT_TRUE(std::is_sorted(thin.kept.begin(), thin.kept.end()));
  for (std::size_t v = 0; v < thin.kept.size(); ++v) {
    const auto& members = cells[cellOf(thin.kept[v])];
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const Index i : members)
      mean += points.col(i) / static_cast<float>(members.size());
    EXPECT_LT((mean - thin.centroids.col(static_cast<Index>(v))).norm(), 1e-5f);
    for (const Index i : members)
      EXPECT_LE((points.col(thin.kept[v]) - mean).norm(), (points.col(i) - mean).norm() + 1e-5f);
  }
}

TEST(VoxelThinning, DoesNotDependOnTheOrderOfThePoints)
{
  // On a lattice many points are equally far from the centroid.
  Points points(3, 1000);
  for (Index i = 0; i < points.cols(); ++i)
    points.col(i) << 0.1f * float(i % 10), 0.1f * float(i / 10 % 10), 0.1f * float(i / 100);
  const Points reversed = points.rowwise().reverse();
  const VoxelThinning a = thinByVoxel(points, 0.35f), b = thinByVoxel(reversed, 0.35f);
  ASSERT_EQ(a.kept.size(), b.kept.size());
  for (std::size_t i = 0; i < a.kept.size(); ++i) {
    const std::size_t k = a.kept.size() - 1 - i;
    EXPECT_EQ(a.kept[i], points.cols() - 1 - b.kept[k]);
    EXPECT_EQ(a.centroids.col(Index(i)), b.centroids.col(Index(k)));
  }
}

TEST(VoxelThinning, OddInput)
{
  EXPECT_TRUE(thinByVoxel(Points(3, 0), 1).kept.empty());
  EXPECT_TRUE(thinByVoxel(Points::Constant(3, 9, nan), 1).kept.empty());
  EXPECT_EQ(thinByVoxel(Points::Ones(3, 50), 0.1f).kept, std::vector<Index>{0});
  const Points points = test::randomPoints(50, 1);
  EXPECT_EQ(thinByVoxel(points, 100).kept.size(), 1u);
  EXPECT_THROW(thinByVoxel(points, 0), std::invalid_argument);
  EXPECT_THROW(thinByVoxel(points, nan), std::invalid_argument);
  EXPECT_THROW(thinByVoxel(points, 1e-7f), std::invalid_argument);
  EXPECT_EQ(thinByVoxel(points, 0.3f, 1).kept, thinByVoxel(points, 0.3f, 4).kept);
}

TEST(MixedPixels, RealScanLosesFewPoints)
{
  FRESCO_NEED_DATA("lobby/room_scan1.pcd");
  const PointSet set = readPoints(test::dataFolder() + "/lobby/room_scan1.pcd");
  const auto kept = withoutMixedPixels(set.points, set.viewpoints);
  EXPECT_GT(kept.size(), 0.95 * static_cast<double>(set.size()));
  EXPECT_LT(kept.size(), static_cast<std::size_t>(set.size()));
}
} // namespace
} // namespace fresco
