// SPDX-License-Identifier: BSD-3-Clause
#include "beam_scan.h"
#include "near_groups.h"
#include <algorithm>
#include <cmath>
#include <fresco/common/parallel.h>
namespace fresco {
namespace {
/// Radians between beams that see jumps apart: about the width of a laser beam at common ranges.
constexpr float least_spacing = 0.003f;
constexpr Index spacing_samples = 1024;

/// Median distance between neighbouring beams, radians.
float beamSpacing(const PointTree& directions)
{
  constexpr int around = 8;
  std::vector<float> squared;
  std::vector<Neighbor> found;
  const Index count = std::min(spacing_samples, directions.size());
  for (Index s = 0; s < count; ++s) {
    directions.nearest(directions.point(s * directions.size() / count), around + 1, found);
    squared.push_back(found.back().squared_distance);
  }
  const auto middle = squared.begin() + count / 2;
  std::nth_element(squared.begin(), middle, squared.end());
  return count > 0 ? std::sqrt(*middle * 3.1416f / around) : 0.f;
}

/// As nearestLists() of every m-th beam, without those closer than half of least_spacing; the beam itself comes first.
NeighborLists thinnedLists(const PointTree& directions, Index m, const VeilOptions& options)
{
  Points some(3, (directions.size() + m - 1) / m);
  for (Index i = 0; i < some.cols(); ++i)
    some.col(i) = directions.point(m * i);
  const PointTree tree(some, options.threads);
  const auto each = static_cast<Index>(options.k) + 1;
  NeighborLists lists = evenLists(directions.size(), each);
  parallelRanges(directions.size(), options.threads, [&](Index begin, Index end) {
    std::vector<Neighbor> found;
    for (Index i = begin; i < end; ++i) {
      int* list = lists.index.data() + lists.begin[i];
      std::fill_n(list, each, static_cast<int>(i));
      Index count = 1;
      tree.nearest(directions.point(i), 2 * options.k, found);
      for (const Neighbor& beam : found)
        if (count < each && beam.squared_distance > 0.25f * least_spacing * least_spacing)
          list[count++] = static_cast<int>(m * beam.index);
    }
  });
  return lists;
}
} // namespace

BeamScan makeBeamScan(const Points& points, const Eigen::Vector3f& viewpoint, const std::vector<Index>& columns,
                      const VeilOptions& options)
{
  const auto n = static_cast<Index>(columns.size());
  Points directions(3, n);
  parallelFor(n, options.threads, [&](Index i) {
    const Eigen::Vector3f beam = points.col(columns[i]) - viewpoint;
    directions.col(i) = beam / beam.norm(); // NaN at the viewpoint: left out by the tree
  });
  auto tree = std::make_unique<PointTree>(directions, options.threads);
  const float times = least_spacing / beamSpacing(*tree);
  const Index m = times * times < static_cast<float>(tree->size()) ? static_cast<Index>(times * times) : 1;
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
  const auto above = std::upper_bound(ranges.begin(), ranges.end(), range) - ranges.begin();
  if (above == 0)
    return deviations.front();
  const auto k = static_cast<std::size_t>(above);
  if (k == ranges.size())
    return deviations.back();
  const float part = (range - ranges[k - 1]) / (ranges[k] - ranges[k - 1]);
  return deviations[k - 1] + part * (deviations[k] - deviations[k - 1]);
}
} // namespace fresco
