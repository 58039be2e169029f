// SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels/beam_scan.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
#include <fresco/search/batch_knn.h>
namespace fresco::filters {
namespace {
/// Radians between beams that see jumps apart: about the width of a laser beam at common ranges.
constexpr float least_spacing = 0.003f;

/// Median distance between neighbouring beams, radians.
float beamSpacing(const PointTree& directions)
{
  constexpr Index spacing_samples = 1024;
  std::vector<float> squared;
  std::vector<Neighbor> found;
  const Index count = std::min(spacing_samples, directions.size());
  for (Index s = 0; s < count; ++s) {
    directions.nearest(directions.point(s * directions.size() / count), beside + 1, found);
    squared.push_back(found.back().squared_distance);
  }
  return count > 0 ? std::sqrt(median(squared) * 3.1416f / beside) : 0.f;
}

/// Searches among every m-th beam. Near ones are found together.
class SomeBeams {
public:
  /// @param some every m-th of `directions`
  SomeBeams(const PointTree& directions, const PointTree& some, Index m) : directions_(directions), some_(some), m_(m)
  {}

  /// Those around the beams begin..end-1.
  void gather(Index begin, Index end, int count)
  {
    middle_.setZero();
    for (Index i = begin; i < end; ++i)
      middle_ += directions_.point(i) / static_cast<float>(end - begin);
    search(middle_, count);
    gathered_.clear();
    PointTree::Key farthest = 0;
    for (const PointTree::Key key : keys_) {
      gathered_.push_back(PointTree::position(key));
      farthest = std::max(farthest, key);
    }
    radius_ = std::sqrt(PointTree::squaredDistance(farthest));
  }

  /// The `count` nearest of a beam without those closer than half of least_spacing, nearest first; positions in
  /// `directions`.
  void list(Index i, int count, std::vector<PointTree::Key>& found)
  {
    const Eigen::Vector3f beam = directions_.point(i);
    const auto sortNearest = [&] {
      const auto apart = [](PointTree::Key key) {
        return PointTree::squaredDistance(key) > 0.25f * least_spacing * least_spacing;
      };
      found.erase(std::partition(found.begin(), found.end(), apart), found.end());
      const auto last = found.begin() + std::min<std::ptrdiff_t>(count, std::distance(found.begin(), found.end()));
      std::partial_sort(found.begin(), last, found.end());
      found.erase(last, found.end());
    };
    found.clear();
    for (const int j : gathered_)
      found.push_back(PointTree::key((directions_.point(j) - beam).squaredNorm(), j));
    sortNearest();
    const bool all = Index(found.size()) == count &&
                     std::sqrt(PointTree::squaredDistance(found.back())) + (beam - middle_).norm() < radius_;
    if (all)
      return;
    search(beam, 2 * count);
    found = keys_;
    sortNearest();
  }

private:
  void search(const Eigen::Vector3f& beam, int count)
  {
    some_.nearestKeys(beam, count, keys_);
    for (PointTree::Key& key : keys_)
      key = PointTree::key(PointTree::squaredDistance(key), m_ * some_.columns()[PointTree::position(key)]);
  }

  const PointTree &directions_, &some_;
  Index m_;
  std::vector<PointTree::Key> keys_;
  std::vector<int> gathered_; ///< positions
  Eigen::Vector3f middle_;    ///< of them
  float radius_ = 0;          ///< all within it are there
};

/// As nearestLists() of every m-th beam, without those closer than half of least_spacing; the beam itself comes first.
NeighborLists thinnedLists(const PointTree& directions, Index m, const MixedPixelOptions& options)
{
  Points every(3, (directions.size() + m - 1) / m);
  for (Index i = 0; i < every.cols(); ++i)
    every.col(i) = directions.point(m * i);
  const PointTree tree(every, options.threads);
  const Index each = options.k + 1;
  NeighborLists lists = evenLists(directions.size(), each);
  const Index of_group = std::max(m, PointTree::leaf_size);
  const Index groups = (directions.size() + of_group - 1) / of_group;
  parallelRanges(groups, options.threads, [&](Index first, Index last) {
    SomeBeams some(directions, tree, m);
    std::vector<PointTree::Key> found;
    for (Index group = first; group < last; ++group) {
      const Index begin = of_group * group, end = std::min(begin + of_group, directions.size());
      some.gather(begin, end, 3 * options.k);
      for (Index i = begin; i < end; ++i) {
        int* list = lists.index.data() + lists.begin[i];
        std::fill_n(list, each, i);
        some.list(i, options.k, found);
        std::transform(found.begin(), found.end(), list + 1, PointTree::position);
      }
    }
  });
  return lists;
}
} // namespace

BeamScan makeBeamScan(const Points& points, const Eigen::Vector3f& viewpoint, const std::vector<Index>& columns,
                      const MixedPixelOptions& options)
{
  const Index n = columns.size();
  Points directions(3, n);
  parallelFor(n, options.threads, [&](Index i) {
    const Eigen::Vector3f beam = points.col(columns[i]) - viewpoint;
    directions.col(i) = beam / beam.norm(); // NaN at the viewpoint: left out by the tree
  });
  auto tree = std::make_unique<PointTree>(directions, options.threads);
  const float times = least_spacing / beamSpacing(*tree);
  const Index m = times * times < tree->size() ? times * times : 1.f;
  BeamScan scan{{}, tree->points(), Eigen::VectorXf(tree->size()), {}, nullptr, false, {}};
  scan.lists = m > 1 ? thinnedLists(*tree, m, options) : nearestLists(*tree, options.k + 1, options.threads);
  for (Index i = 0; i < tree->size(); ++i) {
    scan.columns.push_back(columns[tree->columns()[i]]);
    scan.ranges[i] = (points.col(scan.columns.back()) - viewpoint).norm();
  }
  scan.thinned = m > 1;
  scan.tree = std::move(tree);
  return scan;
}

float RangeNoise::at(float range) const
{
  const std::size_t k = std::upper_bound(ranges.begin(), ranges.end(), range) - ranges.begin();
  if (k == 0)
    return deviations.front();
  if (k == ranges.size())
    return deviations.back();
  const float part = (range - ranges[k - 1]) / (ranges[k] - ranges[k - 1]);
  return deviations[k - 1] + part * (deviations[k] - deviations[k - 1]);
}
} // namespace fresco::filters
