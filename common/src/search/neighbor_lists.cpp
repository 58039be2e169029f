// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/search/batch_knn.h>
#include <fresco/search/compressed_neighbor_lists.h>
#include <fresco/search/neighbors.h>
#include <functional>
#include <iterator>
#include <utility>
namespace fresco {
namespace {
using Keys = std::vector<PointTree::Key>;
constexpr Index group_leaves = 8;         // searched for at once; measured
constexpr std::size_t most_leaves = 2000; // around them; beyond, each point is searched for alone
constexpr float reach_margin = 1.5f;      // how far to look for the k nearest / distance expected

struct Ball {
  Index center; ///< position
  float radius;
};

struct ListLimits {
  int most; ///< neighbours
  int threads;
};

/// Lists found range by range (lists_of_range.index, and counts in lists_of_range.begin) joined to one.
NeighborLists joinLists(std::vector<NeighborLists> ranges, int threads)
{
  NeighborLists all;
  all.begin.push_back(0);
  std::vector<std::int64_t> first;
  for (const auto& range : ranges) {
    first.push_back(all.begin.back());
    for (const auto count : range.begin)
      all.begin.push_back(all.begin.back() + count);
  }
  all.index.resize(all.begin.back());
  const auto copy = [&](Index r) {
    std::copy(ranges[r].index.begin(), ranges[r].index.end(), all.index.begin() + first[r]);
    ranges[r] = {}; // frees memory on the way
  };
  parallelFor(ranges.size(), threads, copy, 1);
  return all;
}

/// Every m-th of `positions`, and `self`; ascending as before.
void thinPositions(std::size_t most, int self, std::vector<int>& positions)
{
  if (positions.size() <= most)
    return;
  const double step = 1.0 * positions.size() / most;
  for (std::size_t j = 0; j < most; ++j)
    positions[j] = positions[(j + 0.5) * step];
  positions.resize(most);
  const auto place = std::lower_bound(positions.begin(), positions.end(), self);
  if (place == positions.end() || *place != self)
    positions.insert(place, self);
}

/// All points in the ball, ascending, from the leaves gathered around the group of its centre or, where those were too
/// many, from the tree.
void findWithin(const PointTree& tree, BatchKnn& group, const Ball& ball, std::vector<int>& found)
{
  const std::size_t count = group.within(ball.center, ball.radius);
  if (count > 0) {
    found.assign(group.positions().begin(), group.positions().begin() + count);
    return;
  }
  thread_local Keys keys;
  tree.withinKeys(tree.point(ball.center), ball.radius, keys);
  found.resize(keys.size());
  std::transform(keys.begin(), keys.end(), found.begin(), PointTree::position);
}

/// Lists of all points within a radius in the form of `Range`: ranges of points in their order, without spare memory.
/// @param add add(range, i, found): point i of a range
template <typename Range, typename Add>
std::vector<Range> searchRadii(const PointTree& tree, const Eigen::VectorXf& radii, const ListLimits& limits,
                               const Add& add)
{
  require(limits.most > 0, "neighbour search: ", limits.most, " neighbours at most");
  require(radii.size() == 1 || radii.size() == tree.size(), "neighbour search: ", radii.size(), " radii for ",
          tree.size(), " points");
  require(radii.size() == 0 || radii.minCoeff() >= 0, "neighbour search: a radius is negative or NaN");
  constexpr Index chunk = 32;
  const std::vector<Index> groups = tree.subtrees(group_leaves);
  const Index count = groups.size() - 1;
  std::vector<Range> ranges((count + chunk - 1) / chunk);
  const auto search = [&](Index begin, Index end) {
    Range range;
    BatchKnn group(tree);
    std::vector<int> found;
    for (Index g = begin; g < end; ++g) {
      group.enter(groups[g], groups[g + 1]);
      group.gather(radii.size() == 1 ? radii[0] : radii.segment(group.begin(), group.end() - group.begin()).maxCoeff(),
                   most_leaves);
      for (Index i = group.begin(); i < group.end(); ++i) {
        findWithin(tree, group, {i, radii[radii.size() == 1 ? 0 : i]}, found);
        thinPositions(limits.most, i, found);
        add(range, i, found);
      }
    }
    ranges[begin / chunk] = std::as_const(range); // a copy has no spare memory
  };
  parallelRanges(count, limits.threads, search, chunk);
  return ranges;
}
} // namespace

NeighborLists evenLists(Index n, Index k)
{
  NeighborLists lists;
  lists.begin.resize(n + 1);
  for (Index i = 0; i <= n; ++i)
    lists.begin[i] = i * k;
  lists.index.resize(n * k);
  return lists;
}

void forNearest(const PointTree& tree, int k, int threads, const std::function<void(Index, const int*, Index)>& use)
{
  const Index each = std::min<Index>(k, tree.size());
  const std::vector<Index> groups = tree.subtrees(group_leaves);
  parallelRanges(groups.size() - 1, threads, [&](Index begin, Index end) {
    BatchKnn group(tree);
    std::vector<int> found(each);
    for (Index g = begin; g < end; ++g) {
      group.enter(groups[g], groups[g + 1]);
      group.gather(reach_margin * group.expectedReach(each), most_leaves);
      for (Index i = group.begin(); i < group.end(); ++i) {
        group.nearest(i, each);
        group.ordered(found.data());
        use(i, found.data(), each);
      }
    }
  });
}

NeighborLists nearestLists(const PointTree& tree, int k, int threads)
{
  require(k > 0, "neighbour search: k ", k, " is below 1");
  const Index each = std::min<Index>(k, tree.size());
  NeighborLists lists = evenLists(tree.size(), each);
  forNearest(tree, k, threads, [&](Index i, const int* found, Index count) {
    std::copy_n(found, count, lists.index.data() + lists.begin[i]);
  });
  return lists;
}

NeighborLists radiusLists(const PointTree& tree, const Eigen::VectorXf& radii, int most, int threads)
{
  const auto add = [](NeighborLists& range, Index, const std::vector<int>& found) {
    range.begin.push_back(found.size());
    range.index.insert(range.index.end(), found.begin(), found.end());
  };
  return joinLists(searchRadii<NeighborLists>(tree, radii, {most, threads}, add), threads);
}

std::vector<CompressedLists> compressedRadiusLists(const PointTree& tree, const Eigen::VectorXf& radii, int most,
                                                   int threads)
{
  const auto add = [](CompressedLists& range, Index i, const std::vector<int>& found) {
    if (range.end == 0)
      range.begin = i;
    range.end = i + 1;
    range.add(found);
  };
  return searchRadii<CompressedLists>(tree, radii, {most, threads}, add);
}

NeighborLists imageLists(const Points& points, Index width, int k, int threads)
{
  require(k > 0, "neighbour search: k ", k, " is below 1");
  require(width > 0 && points.cols() % width == 0, "neighbour search: no image of width ", width, " has ",
          points.cols(), " points");
  const Index height = points.cols() / width;
  // A window of twice k pixels holds the k nearest unless the surface is seen at a grazing angle.
  const Index reach = std::ceil((std::sqrt(2.0 * k) - 1) / 2);
  std::vector<NeighborLists> rows(height);
  parallelFor(height, threads, [&](Index v) {
    Keys keys;
    for (Index u = 0; u < width; ++u) {
      const Eigen::Vector3f center = points.col(v * width + u);
      keys.clear();
      for (Index y = std::max<Index>(0, v - reach); y <= std::min(height - 1, v + reach); ++y)
        for (Index x = std::max<Index>(0, u - reach); x <= std::min(width - 1, u + reach); ++x) {
          const float squared_distance = (points.col(y * width + x) - center).squaredNorm();
          if (std::isfinite(squared_distance)) // never where the centre is not
            keys.push_back(PointTree::key(squared_distance, y * width + x));
        }
      std::sort(keys.begin(), keys.end());
      keys.resize(std::min<std::size_t>(keys.size(), k));
      rows[v].begin.push_back(keys.size());
      std::transform(keys.begin(), keys.end(), std::back_inserter(rows[v].index), PointTree::position);
    }
  });
  return joinLists(std::move(rows), threads);
}
} // namespace fresco
