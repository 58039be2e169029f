// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/cube.h"
#include "poisson/samples/exact_sum.h"
#include "poisson/samples/point_sketch.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
namespace fresco::poisson {
namespace {
using Box = Eigen::AlignedBox3d;

/// What joining in any order makes the same.
struct Totals {
  Index usable = 0;
  Box box;
  ExactSum weight; ///< where points have weights
  float largest_intensity = 0.f;

  void add(const Totals& other)
  {
    usable += other.usable;
    box.extend(other.box);
    weight.add(other.weight);
    largest_intensity = std::max(largest_intensity, other.largest_intensity);
  }

  /// Adds those of the other ranks.
  void share(Exchange& exchange)
  {
    exchange.sum(&usable, 1);
    weight.share(exchange);
    Eigen::Matrix<double, 7, 1> largest;
    largest << box.max(), -box.min(), largest_intensity;
    exchange.largest(largest.data(), largest.size());
    box = Box(-largest.segment<3>(3), largest.head<3>());
    largest_intensity = static_cast<float>(largest[6]);
  }
};

/// Ranks without points learn what points have.
/// @throws std::invalid_argument if those of the ranks are unlike
void shareKind(Exchange& exchange, Extent& extent)
{
  constexpr int n = 6;
  using Numbers = Eigen::Matrix<double, n, 1>;
  Eigen::Matrix<double, n, 2> kind = Eigen::Matrix<double, n, 2>::Constant(-HUGE_VAL);
  if (extent.all > 0) {
    Numbers own;
    own << extent.colors, extent.intensities, static_cast<int>(extent.weights.source), extent.origin;
    kind << own, -own;
  }
  exchange.largest(kind.data(), kind.size());
  require(kind.col(0) == -kind.col(1) || kind.col(0)[0] == -HUGE_VAL,
          "volumetric reconstruction: the points of the ranks have unlike attributes or origins");
  if (kind.col(0)[0] == -HUGE_VAL)
    return;
  extent.colors = kind(0, 0) > 0;
  extent.intensities = kind(1, 0) > 0;
  extent.weights.source = static_cast<Weights::Source>(static_cast<int>(kind(2, 0)));
  extent.origin = kind.col(0).tail<3>();
}

/// Of the usable points of a window.
Totals totalsOf(const PointSet& set, const Extent& extent, int threads)
{
  const auto map = [&](Index begin, Index end) {
    Totals totals;
    for (Index i = begin; i < end; ++i) {
      if (!extent.isUsable(set, i))
        continue;
      ++totals.usable;
      totals.box.extend(set.points.col(i).cast<double>());
      if (extent.weights.source != Weights::Source::none)
        totals.weight.add(extent.weights.given(set, i));
      if (extent.intensities && std::isfinite(set.intensities[i]))
        totals.largest_intensity = std::max(totals.largest_intensity, std::abs(set.intensities[i]));
    }
    return totals;
  };
  const auto join = [](Totals a, const Totals& b) {
    a.add(b);
    return a;
  };
  return parallelReduce(set.size(), threads, Totals(), map, join, chunk_size);
}

/// What a window says of itself.
void lookAt(const PointSet& set, const VolumetricOptions& options, Extent& extent)
{
  validatePointSet(set);
  require(set.hasNormals(), "volumetric reconstruction: the points have no normals");
  extent.origin = set.origin;
  extent.colors = set.colors.cols() > 0;
  extent.intensities = set.intensities.size() > 0;
  if (options.confidence)
    extent.weights.source = set.confidences.size() > 0 ? Weights::Source::confidences : Weights::Source::normal_lengths;
}

/// Reads the points that `extent` lets through. @param sketch receives them, too, unless nullptr
Totals readTotals(const PointStream& points, const VolumetricOptions& options, Exchange& exchange, Extent& extent,
                  PointSketch* sketch)
{
  const int threads = options.threads;
  Totals totals;
  extent.all = extent.windows = 0;
  points.read([&](const PointSet& set) {
    if (set.size() == 0)
      return;
    lookAt(set, options, extent);
    extent.all += set.size();
    ++extent.windows;
    totals.add(totalsOf(set, extent, threads));
    if (sketch)
      sketch->add(
          set, [&](Index i) { return extent.isUsable(set, i); }, threads);
  });
  if (exchange.size() > 1) {
    shareKind(exchange, extent);
    totals.share(exchange);
    exchange.sum(&extent.all, 1);
    exchange.sum(&extent.windows, 1);
  }
  return totals;
}

/// Box of a sample of the points, without the lowest and highest of each axis.
Box innerBox(const PointSketch& sketch)
{
  constexpr double outlier_share = 0.001; // beams that return from far beyond a window or a mirror are rarer
  constexpr Index few_outliers = 4;       // where there are too few points for the share
  Eigen::Vector3d lower, upper;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values = sketch.coordinates(axis);
    const Index n = values.size();
    const Index drop = std::min(std::max(few_outliers, static_cast<Index>(outlier_share * n)), n / 16);
    lower[axis] = rankedValue(values, drop);
    upper[axis] = rankedValue(values, n - 1 - drop);
  }
  return Box(lower, upper);
}

Cube fitCube(const Box& box, const VolumetricOptions& options)
{
  Cube cube;
  cube.depth = options.depth;
  cube.side = box.sizes().maxCoeff() * options.scale;
  if (options.cell_size > 0) {
    cube.depth = std::max(2, static_cast<int>(std::ceil(std::log2(cube.side / options.cell_size))));
    require(cube.depth <= 16, "volumetric reconstruction: a cell size of ", options.cell_size, " needs octree depth ",
            cube.depth, ", above 16, for points that extend over ", cube.side);
    cube.side = std::ldexp(options.cell_size, cube.depth);
  }
  cube.corner = box.center().array() - 0.5 * cube.side;
  return cube;
}

void requireEnough(const Extent& extent, Index usable)
{
  constexpr Index least_points = 4;             // fewer enclose no volume
  constexpr Index most_points = Index(1) << 34; // their sums fit, see CellSums
  require(usable >= least_points, "volumetric reconstruction: ", usable, " of ", extent.all,
          " points are usable (finite, with a normal that is finite and not zero); at least ", least_points,
          " are needed");
  require(usable <= most_points, "volumetric reconstruction: ", usable, " points are more than 2^34");
}
} // namespace

float Weights::given(const PointSet& set, Index i) const
{
  if (source == Source::none)
    return 1.f;
  const float w = source == Source::confidences ? set.confidences[i] : set.normals.col(i).norm();
  return std::isfinite(w) ? w : 0.f;
}

Extent findExtent(const PointStream& points, const VolumetricOptions& options, Exchange& exchange)
{
  Extent extent;
  PointSketch sketch;
  Totals totals = readTotals(points, options, exchange, extent, &sketch);
  sketch.share(exchange);
  requireEnough(extent, totals.usable);
  const Box inner = innerBox(sketch);
  const double margin = inner.sizes().maxCoeff(); // an outlier is farther off the others than they extend
  const Box allowed(inner.min().array() - margin, inner.max().array() + margin);
  if (margin > 0 && !allowed.contains(totals.box)) {
    extent.allowed = allowed;
    totals = readTotals(points, options, exchange, extent, nullptr);
    requireEnough(extent, totals.usable);
  }
  require(totals.box.sizes().maxCoeff() > 1e-30, "volumetric reconstruction: all ", totals.usable,
          " usable points coincide");
  extent.usable = totals.usable;
  extent.largest_intensity = totals.largest_intensity;
  if (extent.weights.source != Weights::Source::none)
    extent.weights.scale = static_cast<double>(totals.usable) / totals.weight.value();
  extent.cube = fitCube(totals.box, options);
  extent.cells_per_unit = 1.0 / extent.cube.cell();
  return extent;
}
} // namespace fresco::poisson
