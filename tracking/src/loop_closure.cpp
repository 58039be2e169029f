// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel_batches.h>
namespace fresco::tracking {
namespace {
constexpr Index fewest_votes = 12; // features that agree on a pose: unrelated images reach some 6

/// Correlation of two coarse images, -1..1.
double likeness(const RgbdPyramid& a, const RgbdPyramid& b)
{
  const Plane &x = a.levels.back().gray, &y = b.levels.back().gray;
  if (x.data.size() != y.data.size() || x.data.empty())
    return -1;
  double sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;
  const double n = x.data.size();
  for (std::size_t i = 0; i < x.data.size(); ++i) {
    sx += x.data[i];
    sy += y.data[i];
    xx += x.data[i] * x.data[i];
    yy += y.data[i] * y.data[i];
    xy += x.data[i] * y.data[i];
  }
  const double spread = (xx - sx * sx / n) * (yy - sy * sy / n);
  return spread > 0 ? (xy - sx * sy / n) / std::sqrt(spread) : -1;
}
} // namespace

std::vector<Index> mostAlike(const std::vector<KeyFrame>& key_frames, const RgbdPyramid& frame)
{
  std::vector<std::pair<double, Index>> order;
  for (std::size_t k = 0; k < key_frames.size(); ++k)
    order.emplace_back(-likeness(key_frames[k].pyramid, frame), k);
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), most_alike));
  std::vector<Index> chosen;
  for (const auto& [unlikeness, k] : order)
    chosen.push_back(k);
  return chosen;
}

KeyFrameEdges alignByFeatures(const TrackingMap& map, Index a, Index b)
{
  const KeyFrame &first = map.key_frames[a], &second = map.key_frames[b];
  const auto found = matchFrames(first.features, second.features);
  if (found.empty() || found[0].votes < fewest_votes)
    return {};
  return alignBothWays(map, {a, b, found[0].T_a_b}, 2);
}

Index closeLoops(TrackingMap& map, int threads, const Progress& progress)
{
  const Index count = map.key_frames.size();
  std::vector<KeyFrameEdges> found(count);
  const auto look = [&](Index b) {
    for (const Index a : mostAlike(map.key_frames, map.key_frames[b].pyramid))
      if (a + 1 < b)
        for (const KeyFrameEdge& edge : alignByFeatures(map, a, b))
          found[b].push_back(edge);
  };
  parallelBatches(count, threads, progress, "loops", look);
  Index pairs = 0;
  for (const KeyFrameEdges& edges : found) {
    map.edges.insert(map.edges.end(), edges.begin(), edges.end());
    pairs += edges.size() / 2;
  }
  return pairs;
}
} // namespace fresco::tracking
