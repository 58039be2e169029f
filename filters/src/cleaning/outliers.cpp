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

/// Median of the values of each list.
Eigen::VectorXf medians(const Eigen::VectorXf& values, const NeighborLists& lists, int threads)
{
  Eigen::VectorXf result(values.size());
  parallelFor(values.size(), threads, [&](Index i) {
    thread_local std::vector<float> around;
    around.clear();
    for (const int* j = lists.first(i); j != lists.last(i); ++j)
      around.push_back(values[*j]);
    result[i] = median(around);
  });
  return result;
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

/// Columns of the positions that stay, ascending.
template <typename Stays>
std::vector<Index> columnsWhere(const PointTree& tree, const Stays& stays)
{
  std::vector<Index> kept;
  for (Index i = 0; i < tree.size(); ++i)
    if (stays(i))
      kept.push_back(tree.columns()[i]);
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// Spacing around each point, in a common unit, by the points that count it among their neighbours: a surface that a
/// point sees from afar does not count it. Infinite where none does.
/// @param place first point at the same place as each
Eigen::VectorXf spacings(const PointTree& tree, const ScatterOptions& options, std::vector<int>& place)
{
  const NeighborLists lists = nearestLists(tree, options.k + 1, options.threads);
  Eigen::VectorXd density = Eigen::VectorXd::Zero(tree.size());
  for (Index i = 0; i < tree.size(); ++i) {
    place.push_back(*lists.first(i));
    const double reach = (tree.point(lists.last(i)[-1]) - tree.point(i)).norm();
    for (const int* j = lists.first(i); j != lists.last(i); ++j)
      density[*j] += *j == i ? 0 : 1 / (reach * reach * reach);
  }
  return density.array().pow(-1 / 3.).cast<float>();
}

/// 1 / dimension around each point by its list (Levina & Bickel 2004).
/// @param tree at least three points, no two at the same place
Eigen::VectorXf inverseDimensions(const PointTree& tree, const NeighborLists& lists, int threads)
{
  Eigen::VectorXf result(tree.size());
  parallelFor(tree.size(), threads, [&](Index i) {
    const float reach = (tree.point(lists.last(i)[-1]) - tree.point(i)).norm();
    double sum = 0;
    for (const int* j = lists.first(i) + 1; j < lists.last(i); ++j)
      sum += std::log(reach / (tree.point(*j) - tree.point(i)).norm());
    result[i] = sum / (lists.count(i) - 2);
  });
  return result;
}

/// Marks those of `peers`, positions in `tree`, that fill a volume among them.
void markVolumes(const PointTree& tree, const std::vector<int>& peers, const ScatterOptions& options,
                 std::vector<char>& scattered)
{
  const PointTree among(tree.points()(Eigen::all, peers), options.threads);
  const NeighborLists lists = nearestLists(among, 3 * options.k + 1, options.threads);
  Eigen::VectorXf inverse = inverseDimensions(among, lists, options.threads);
  for (int round = 0; round < 2; ++round) // one list tells the dimension to 0.4 only
    inverse = medians(inverse, lists, options.threads);
  for (Index i = 0; i < among.size(); ++i)
    if (inverse[i] * options.dimension < 1)
      scattered[peers[among.columns()[i]]] = true;
}
} // namespace

std::vector<Index> withoutOutliers(const Points& points, const OutlierOptions& options)
{
  require(options.k >= 1, "outliers: k ", options.k, " is below 1");
  require(std::isfinite(options.sigma), "outliers: sigma is not finite");
  const PointTree tree(points, options.threads);
  const NeighborLists lists = nearestLists(tree, options.k + 1, options.threads);
  Eigen::VectorXf values = meanDistances(tree, lists, options.threads);
  if (const float least = std::numeric_limits<float>::min(); options.relative)
    values = (values.array().max(least) / medians(values, lists, options.threads).array().max(least)).log();
  const double most = threshold(values, options);
  return columnsWhere(tree, [&](Index i) { return !(values[i] > most); });
}

std::vector<Index> withoutScatter(const Points& points, const ScatterOptions& options)
{
  require(options.k >= 2, "scatter: k ", options.k, " is below 2");
  require(options.dimension > 0, "scatter: dimension ", options.dimension, " is not above 0");
  const PointTree tree(points, options.threads);
  std::vector<int> place, peers;
  const Eigen::VectorXf spacing = spacings(tree, options, place);
  for (Index i = 0; i < tree.size(); ++i)
    if (place[i] == i)
      peers.push_back(i);
  std::vector<char> scattered(tree.size(), false);
  float least = tree.size() > 0 ? median(Eigen::VectorXf(spacing)) : 0.f; // what is scattered is sparser than most
  while (Index(peers.size()) > options.k) {
    const auto denser = [&](int i) { return !(spacing[i] > 2 * least); };
    peers.erase(std::remove_if(peers.begin(), peers.end(), denser), peers.end());
    if (Index(peers.size()) > options.k)
      markVolumes(tree, peers, options, scattered);
    least = peers.empty() ? 0.f : spacing(peers).minCoeff();
  }
  return columnsWhere(tree, [&](Index i) { return !scattered[place[i]]; });
}
} // namespace fresco
