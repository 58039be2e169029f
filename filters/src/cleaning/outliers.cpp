// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/filters/core/outliers.h>
#include <fresco/search/neighbors.h>
namespace fresco {
namespace {
/// Mean distance of each point to the others of its list, by position; 0 without others.
Eigen::VectorXf meanDistances(const PointTree& tree, const NeighborLists& lists, int threads)
{
  Eigen::VectorXf means(tree.size());
  parallelFor(tree.size(), threads, [&](Index i) {
    double sum = 0;
    for (const int* j = lists.first(i); j != lists.last(i); ++j)
      sum += (tree.point(*j) - tree.point(i)).norm();
    means[i] = sum / std::max<Index>(1, lists.count(i) - 1);
  });
  return means;
}

/// Logarithm of each value over the median of those of its list.
Eigen::VectorXf logRatios(const Eigen::VectorXf& values, const NeighborLists& lists, int threads)
{
  const float least = std::numeric_limits<float>::min();
  Eigen::VectorXf ratios(values.size());
  parallelFor(values.size(), threads, [&](Index i) {
    thread_local std::vector<float> around;
    around.clear();
    for (const int* j = lists.first(i); j != lists.last(i); ++j)
      around.push_back(values[*j]);
    ratios[i] = std::log(std::max(values[i], least) / std::max(median(around), least));
  });
  return ratios;
}

double threshold(const Eigen::VectorXf& values, const OutlierOptions& options)
{
  using Sums = Eigen::Array2d;
  const Index n = values.size();
  const Sums sums = parallelSum(n, options.threads, Sums(0, 0),
                                [&](Index i) { return Sums(values[i], static_cast<double>(values[i]) * values[i]); });
  const double mean = sums[0] / n;
  const double variance = n > 1 ? std::max(0.0, (sums[1] - sums[0] * mean) / (n - 1)) : 0.0;
  return mean + options.sigma * std::sqrt(variance);
}
} // namespace

std::vector<Index> withoutOutliers(const Points& points, const OutlierOptions& options)
{
  require(options.k >= 1, "outliers: k ", options.k, " is below 1");
  require(std::isfinite(options.sigma), "outliers: sigma is not finite");
  const PointTree tree(points, options.threads);
  const NeighborLists lists = nearestLists(tree, options.k + 1, options.threads);
  Eigen::VectorXf values = meanDistances(tree, lists, options.threads);
  if (options.relative)
    values = logRatios(values, lists, options.threads);
  const double most = threshold(values, options);
  std::vector<Index> kept;
  for (Index i = 0; i < tree.size(); ++i)
    if (!(values[i] > most))
      kept.push_back(tree.columns()[i]);
  std::sort(kept.begin(), kept.end());
  return kept;
}
} // namespace fresco
