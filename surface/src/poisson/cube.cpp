// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/cube.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
namespace fresco::poisson {
namespace {
using Box = Eigen::AlignedBox3d;

bool isUsable(const PointSet& set, const Weights& weights, Index i)
{
  const float length = set.normals.col(i).squaredNorm();
  return set.points.col(i).allFinite() && std::isfinite(length) && length > 1e-20f && weights.of(set, i) > 0;
}

/// Box of the points, or of a sample of them, without the lowest and highest of each axis.
Box innerBox(const PointSet& set, const Array<std::uint32_t>& points)
{
  constexpr std::size_t quantile_points = 1 << 17; // enough for 131 points beyond the quantile
  constexpr double outlier_share = 0.001;          // beams that return from far beyond a window or a mirror are rarer
  constexpr Index few_outliers = 4;                // where there are too few points for the share
  const std::size_t stride = (points.size() + quantile_points - 1) / quantile_points;
  std::vector<float> values;
  Box box;
  Eigen::Vector3d lower, upper;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t k = 0; k < points.size(); k += stride)
      values.push_back(set.points(axis, points[k]));
    const Index n = values.size();
    const Index drop = std::min(std::max(few_outliers, static_cast<Index>(outlier_share * n)), n / 16);
    lower[axis] = rankedValue(values, drop);
    upper[axis] = rankedValue(values, n - 1 - drop);
  }
  return Box(lower, upper);
}

Box boxOf(const PointSet& set, const Array<std::uint32_t>& points, int threads)
{
  const auto map = [&](Index begin, Index end) {
    Box box;
    for (Index k = begin; k < end; ++k)
      box.extend(set.points.col(points[k]).cast<double>());
    return box;
  };
  const auto join = [](const Box& a, const Box& b) { return a.merged(b); };
  return parallelReduce(points.size(), threads, Box(), map, join);
}

/// An outlier is farther off the others than they extend.
/// @return box of the points that are left
Box dropOutliers(const PointSet& set, Array<std::uint32_t>& points, int threads)
{
  const Box inner = innerBox(set, points), box = boxOf(set, points, threads);
  const double margin = inner.sizes().maxCoeff();
  const Box allowed(inner.min().array() - margin, inner.max().array() + margin);
  if (!(margin > 0) || allowed.contains(box))
    return box;
  const auto outside = [&](Index i) { return !allowed.contains(set.points.col(i).cast<double>()); };
  points.erase(std::remove_if(points.begin(), points.end(), outside), points.end());
  return boxOf(set, points, threads);
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

Weights chooseWeights(const PointSet& set, const VolumetricOptions& options)
{
  Weights weights;
  if (options.confidence)
    weights.source = set.confidences.size() > 0 ? Weights::Source::confidences : Weights::Source::normal_lengths;
  return weights;
}
} // namespace

double Weights::of(const PointSet& set, Index i) const
{
  if (source == Source::none)
    return 1.0;
  const double w = source == Source::confidences ? set.confidences[i] : set.normals.col(i).norm();
  return std::isfinite(w) ? scale * w : 0.0;
}

Usable usablePoints(const PointSet& set, const VolumetricOptions& options)
{
  Usable usable;
  usable.weights = chooseWeights(set, options);
  usable.points = selectIndices(set.size(), options.threads, [&](Index i) { return isUsable(set, usable.weights, i); });
  const auto enough = [&] {
    constexpr std::size_t least_points = 4; // fewer enclose no volume
    require(usable.points.size() >= least_points, "volumetric reconstruction: ", usable.points.size(), " of ",
            set.size(), " points are usable (finite, with a normal that is finite and not zero); at least ",
            least_points, " are needed");
  };
  enough();
  const Box box = dropOutliers(set, usable.points, options.threads);
  enough();
  require(box.sizes().maxCoeff() > 1e-30, "volumetric reconstruction: all ", usable.points.size(),
          " usable points coincide");
  const Index n = usable.points.size();
  const double sum =
      parallelSum(n, options.threads, 0.0, [&](Index k) { return usable.weights.of(set, usable.points[k]); });
  usable.weights.scale = n / sum;
  usable.cube = fitCube(box, options);
  return usable;
}
} // namespace fresco::poisson
