// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/halo.h"
#include "poisson/samples/density.h"
#include "poisson/samples/noise.h"
#include "poisson/solver/constraints.h"
#include "poisson/solver/low_pass_filter.h"
#include "surface/poisson/volumetric_shapes.h"
#include <fresco/core/mesh.h>
#include <fresco/core/statistics.h>
#include <gtest/gtest.h>
using namespace fresco::poisson;
namespace fresco::test {
namespace {
using namespace poisson;

/// A sphere whose upper half has 50 times as many points as the lower one.
PointSet unevenSphere(Index count)
{
  const PointSet even = sphere(count);
  std::vector<Index> kept;
  for (Index i = 0; i < count; ++i)
    if (even.points(2, i) > 0 || i % 50 == 0)
      kept.push_back(i);
  return selectPoints(even, kept);
}

/// However many points a cloud has elsewhere: a bound that grew with them took the density of all but the densest
/// places.
TEST(VolumetricScales, DensityDoesNotDependOnPointsFarAway)
{
  Samples samples = gatherSamples(sphere(3000), atDepth(6));
  const Octree tree = buildOctree(samples.codes, 6, 2, 1);
  const auto atLast = [&] {
    const Eigen::Vector3f place = samples.samples.back().position;
    const Density density(tree, samples, 1);
    return Density::Reader(density).at(6, tree.levels[6].size() - 1, place);
  };
  const Density::Estimate before = atLast();
  samples.samples.front().area = 1e9f;
  EXPECT_EQ(atLast().depth, before.depth);
  EXPECT_EQ(atLast().area, before.area);
  EXPECT_EQ(atLast().support, before.support);
}

/// What was asked before does not matter.
TEST(VolumetricScales, DensityInAnyOrder)
{
  const Samples samples = gatherSamples(sphere(2000), atDepth(6));
  const Octree tree = buildOctree(samples.codes, 6, 2, 1);
  const Density density(tree, samples, 1);
  Density::Reader reader(density);
  const Index bricks = tree.levels[6].size();
  for (Index k = 0; k < 500; ++k) {
    const Index b = k * 7919 % bricks;
    const Eigen::Vector3f place = tree.levels[6].origin(b) + Eigen::Vector3f(k % 5, k % 3 + 0.7f, k % 4 + 0.2f);
    const Density::Estimate once = Density::Reader(density).at(6, b, place), again = reader.at(6, b, place);
    EXPECT_EQ(once.depth, again.depth);
    EXPECT_EQ(once.area, again.area);
    EXPECT_EQ(once.support, again.support);
  }
}

/// Sum over the nodes, each counted once, of the field times visit(node in cells).
template <typename Function>
double momentOf(const BrickLevel& level, const NodeField& field, const Function& function)
{
  double sum = 0;
  for (Index b = 0; b < level.size(); ++b)
    for (int n = 0; n < 125; ++n)
      if (holdsNode(level, b, n % 5, n / 5 % 5, n / 25)) {
        const Eigen::Vector3f node = level.origin(b) + Eigen::Vector3i(n % 5, n / 5 % 5, n / 25).cast<float>();
        sum += field.value(level, b, n % 5, n / 5 % 5, n / 25) * function(node.cast<double>().eval());
      }
  return sum;
}

/// b_i = integral V . grad B_i, and hat functions reproduce linear functions, so the sum of b_i f(x_i) is the integral
/// of V . grad f for linear f, and for |x|^2 / 2 because the kernels are even, whatever the depths at which samples are
/// spread: per depth, in its cells, the sum over the samples of area times normal . grad f.
TEST(VolumetricScales, RightHandSideHasTheMomentsOfTheNormalsAtEveryDepth)
{
  VolumetricOptions options = atDepth(6);
  options.scale = 3.f; // kernels of the coarse depths stay in the cube
  Samples samples = gatherSamples(sphere(3000), options);
  const Octree tree = buildOctree(samples.codes, 6, 6, 2);
  for (std::size_t i = 0; i < samples.samples.size(); ++i) {
    samples.samples[i].depth = 3.f + 0.35f * static_cast<float>(i % 10);
    samples.samples[i].area = 1.f + samples.samples[i].normal.x() / 2;
  }
  Constraints constraints = splatNormals(tree, finestLevel(samples, 2), normalsOf(samples, 2), 2);
  for (int d = 2; d <= 6; ++d) {
    addCoarser(tree, d, 2, constraints);
    double along = 0, across = 0, flux = 0, area = 0;
    const double scale = std::ldexp(1.0, d - 6);
    for (const Sample& s : samples.samples) {
      area += s.area * scale * scale;
      along += s.area * scale * scale * s.normal.x();
      across += s.area * scale * scale * s.normal.y();
      flux += s.area * scale * scale * scale * s.normal.dot(s.position);
    }
    const BrickLevel& level = tree.levels[d];
    const NodeField& field = constraints.fine[d];
    EXPECT_NEAR(momentOf(level, field, [](const Eigen::Vector3d&) { return 1.0; }), 0, 1e-3 * area) << d;
    EXPECT_NEAR(momentOf(level, field, [](const Eigen::Vector3d& x) { return x.x(); }), along, 2e-3 * area) << d;
    EXPECT_NEAR(momentOf(level, field, [](const Eigen::Vector3d& x) { return x.y(); }), across, 2e-3 * area) << d;
    if (d >= 4) { // at coarser ones |x|^2 of the finer nodes is interpolated too roughly
      EXPECT_NEAR(momentOf(level, field, [](const Eigen::Vector3d& x) { return x.squaredNorm() / 2; }), flux,
                  0.03 * std::abs(flux))
          << d;
    }
  }
}

TEST(VolumetricScales, AreasAndDepthsOfSamplesFollowTheDensity)
{
  Samples samples = gatherSamples(unevenSphere(100000), atDepth(8));
  const Octree tree = buildOctree(samples.codes, 8, 5, 2);
  estimateDensity(tree, Density(tree, samples, 2), 1.f, samples, 2);
  Eigen::Array2d area(0, 0), depth(0, 0);
  for (const Sample& s : samples.samples) {
    const double z = samples.cube.corner.z() + samples.cube.cell() * static_cast<double>(s.position.z());
    if (std::abs(z) < 0.3)
      continue; // estimates there see both halves
    const int half = z > 0;
    area[half] += s.area * samples.cube.cell() * samples.cube.cell();
    depth[half] += s.area * samples.cube.cell() * samples.cube.cell() * s.depth;
  }
  for (const int half : {0, 1})
    EXPECT_NEAR(area[half], 0.7 * 2 * pi, 0.1 * 2 * pi) << half;
  depth /= area;
  EXPECT_NEAR(depth[1] - depth[0], std::log2(50.0) / 2, 0.3); // a level for each factor of four
  EXPECT_NEAR(depth[1], std::log2(std::sqrt(100000 / (4 * pi)) * samples.cube.side), 0.3);
}

/// Median of the samples, in the unit of the points.
double medianNoise(const PointSet& points, int depth)
{
  Samples samples = gatherSamples(points, atDepth(depth));
  const Octree tree = buildOctree(samples.codes, depth, 5, 2);
  estimateDensity(tree, Density(tree, samples, 2), 1.f, samples, 2);
  estimateNoise(samples, onlyRank(), 2);
  std::vector<float> noise;
  for (const Sample& s : samples.samples)
    noise.push_back(s.noise);
  return samples.cube.cell() * static_cast<double>(median(noise));
}

TEST(VolumetricScales, NoiseIsFoundAndErrorsOfNormalsAreNotTakenForIt)
{
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  PointSet noisy = sphere(30000), tilted = sphere(3000);
  for (Index i = 0; i < noisy.size(); ++i)
    noisy.points.col(i) *= 1.f + 0.01f * normal(random);
  for (Index i = 0; i < tilted.size(); ++i) {
    tilted.normals.col(i) += 0.15f * Eigen::Vector3f(normal(random), normal(random), normal(random));
    tilted.normals.col(i).normalize();
  }
  EXPECT_NEAR(medianNoise(noisy, 8), 0.01, 0.003);
  EXPECT_LT(medianNoise(tilted, 8), 0.001); // such normals are 7 mm off where neighbours lie, 65 mm away
  for (Index i = 0; i < noisy.size(); ++i)  // and do not hide the noise
    noisy.normals.col(i) =
        (noisy.normals.col(i) + 0.3f * Eigen::Vector3f(normal(random), normal(random), normal(random))).normalized();
  EXPECT_NEAR(medianNoise(noisy, 8), 0.01, 0.003);
}

TEST(VolumetricScales, DensityDoesNotBendTheUnscreenedSurface)
{
  VolumetricOptions options = atDepth(6);
  options.point_weight = 0;
  const VolumetricResult result = reconstructVolumetric(unevenSphere(100000), options);
  EXPECT_LT(maxDistance(result.mesh, sphereDistance), 1.0 * result.cell_size);
  EXPECT_LT(meanDistance(result.mesh, sphereDistance), 0.25 * result.cell_size);
}

/// A complete octree of depth 4 and samples with the given depth and noise.
struct FilterCase {
  explicit FilterCase(float depth, float noise) : samples(gatherSamples(sphere(2000), atDepth(4)))
  {
    tree = buildOctree(samples.codes, 4, 4, 1);
    for (Sample& s : samples.samples) {
      s.depth = depth;
      s.noise = noise;
      s.area = 1.f;
    }
  }

  template <typename Function>
  NodeField filtered(const Function& function) const
  {
    const BrickLevel& level = tree.levels[4];
    NodeField chi(level), spare(level);
    for (Index b = 0; b < level.size(); ++b) {
      float nodes[125];
      for (int n = 0; n < 125; ++n)
        nodes[n] = function(level.origin(b) + Eigen::Vector3i(n % 5, n / 5 % 5, n / 25).cast<float>());
      chi.store(level, b, nodes);
    }
    LowPassFilter(level, finestLevel(samples, 1), 4, 1).apply(chi, spare);
    return chi;
  }

  /// Largest of |chi - factor * function| over the nodes `margin` cells from the cube's boundary.
  template <typename Function>
  double deviation(const NodeField& chi, double factor, float margin, const Function& function) const
  {
    const BrickLevel& level = tree.levels[4];
    double largest = 0;
    for (Index b = 0; b < level.size(); ++b)
      for (int n = 0; n < 125; ++n) {
        const Eigen::Vector3f x = level.origin(b) + Eigen::Vector3i(n % 5, n / 5 % 5, n / 25).cast<float>();
        if (x.minCoeff() >= margin && x.maxCoeff() <= 16 - margin)
          largest = std::max(largest, std::abs(chi.value(level, b, n % 5, n / 5 % 5, n / 25) -
                                               factor * static_cast<double>(function(x))));
      }
    return largest;
  }

  Samples samples;
  Octree tree;
};

float alternating(const Eigen::Vector3f& x) { return static_cast<int>(std::lround(x.x() + x.y())) % 2 ? -1.f : 1.f; }
float quadratic(const Eigen::Vector3f& x) { return 0.1f * x.x() * x.x() - 0.05f * x.x() * x.y() + x.z() - 3.f; }

TEST(VolumetricScales, FilterTakesOutWavesThatAreNotSustained)
{
  for (const float lack : {0.f, 1.25f, 3.f}) {
    const FilterCase sparse(4 - lack, 0.f);
    const double left = lack == 0.f ? 1.0 : lack < 2 ? 0.75 : 0.5;
    EXPECT_LT(sparse.deviation(sparse.filtered(alternating), left, 3, alternating), 1e-5) << lack;
    EXPECT_LT(sparse.deviation(sparse.filtered(quadratic), 1, 3, quadratic), 1e-4) << lack;
  }
  const FilterCase noisy(4, 0.5f);
  EXPECT_LT(noisy.deviation(noisy.filtered(alternating), 0, 3, alternating), 1e-5);
  EXPECT_LT(noisy.deviation(noisy.filtered(quadratic), 1, 3, quadratic), 1e-4);
}

TEST(VolumetricScales, FilterLeavesWhatComesFromTheCoarserDepth)
{
  const FilterCase noisy(4, 0.5f);
  const BrickLevel& level = noisy.tree.levels[4];
  const NodeField chi = noisy.filtered(alternating);
  for (Index b = 0; b < level.size(); ++b)
    for (int i = 0; i < own_nodes; ++i)
      if (fixedNodes(level.neighborsOf(b)) >> i & 1) {
        const Eigen::Vector3f x = level.origin(b) + Eigen::Vector3i(i & 3, i >> 2 & 3, i >> 4).cast<float>();
        EXPECT_EQ(chi.own(b)[i], alternating(x));
      }
}

/// Distance from the nearest of two sheets of 1.4 x 1 a quarter apart, which are 0.01 and 0.005 thick.
double sheetsDistance(const Eigen::Vector3d& p)
{
  double least = 1e9;
  for (const auto& [x, thickness] : {std::pair(0.0, 0.01), std::pair(0.25, 0.005)}) {
    const Eigen::Array3d middle(x, 0, 0), half(thickness / 2, 0.5, 0.7);
    least = std::min(least, ((p.array() - middle).abs() - half).max(0).matrix().norm());
  }
  return least;
}

/// Coarse depths, whose cells hold both sides of a sheet, leave the space between the sheets empty.
TEST(VolumetricScales, NothingGrowsBetweenThinSheets)
{
  PointSet points;
  for (const auto& [x, thickness] : {std::pair(0.f, 0.01f), std::pair(0.25f, 0.005f)}) {
    PointSet sides = sheet(133333, thickness);
    sides.points.row(0).array() += x;
    appendPoints(points, sides);
  }
  for (const float point_weight : {0.f, VolumetricOptions().point_weight})
    for (const int depth : {7, 8, 9}) {
      VolumetricOptions options = atDepth(depth);
      options.point_weight = point_weight;
      const VolumetricResult result = reconstructVolumetric(points, options);
      EXPECT_LT(maxDistance(result.mesh, sheetsDistance), 3.25 * result.cell_size) << depth << ", " << point_weight;
    }
}

/// Nodes of the grid that see no inside would leave holes.
TEST(VolumetricScales, SheetsOfHalfACellAreWhole)
{
  for (const float noise : {0.f, 0.002f}) {
    PointSet points = sheet(100000, 0.005f);
    std::mt19937 random(5);
    std::normal_distribution<float> offset(0.f, noise);
    for (Index i = 0; noise > 0 && i < points.size(); ++i)
      points.points(0, i) += offset(random);
    VolumetricOptions options;
    options.cell_size = 0.01;
    const TriangleMesh mesh = reconstructVolumetric(points, options).mesh;
    const auto distance = [](const Eigen::Vector3d& p) {
      return ((p.array().abs() - Eigen::Array3d(0.0025, 0.5, 0.7)).max(0)).matrix().norm();
    };
    EXPECT_GT(surfaceArea(mesh), 0.97 * 2 * 1.4) << noise;
    EXPECT_LT(maxDistance(mesh, distance), 0.02) << noise;
  }
}

/// Cells finer than the noise add faces, not roughness. Without the filter it is 4.2 and 12.3 degrees.
TEST(VolumetricScales, NormalsOfNoisyPointsDoNotCollapseAtFinerDepths)
{
  PointSet points = sphere(30000);
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.f, 0.01f);
  for (Index i = 0; i < points.size(); ++i)
    points.points.col(i) *= 1.f + noise(random);
  EXPECT_LT(meanAngleToSphere(reconstructVolumetric(points, atDepth(6)).mesh), 3.5); // cells of 3.4 times the noise
  EXPECT_LT(meanAngleToSphere(reconstructVolumetric(points, atDepth(8)).mesh), 10);  // of 0.86 times the noise
}
} // namespace
} // namespace fresco::test
