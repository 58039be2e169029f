// SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels/mixed_pixel_score.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/filters/core/veil_points.h>
namespace fresco {
using namespace filters;
namespace {
constexpr Index fewest = 12; // points of a viewpoint that can be judged
// Scores of veil points. Beams that overlap tell so much that with -1 few are missed and few points taken wrongly; else
// thin things stay when in doubt.
constexpr float least_score = 0, least_of_overlapping = -1;

/// Marks the columns of veil points.
void judge(BeamScan scan, const VeilOptions& options, std::vector<char>& veil)
{
  if (static_cast<Index>(scan.columns.size()) <= fewest)
    return;
  if (options.noise > 0)
    scan.noise = {{0}, {options.noise}};
  else
    scan.noise = measureNoise(scan, options.threads);
  const std::vector<float> scores = firstScores(scan, options);
  const float least = scan.thinned ? least_of_overlapping : least_score;
  forLikelyVeil(scan, options, scores,
                [&](Index i, const LikelyFigures& figures) { veil[scan.columns[i]] = veilScore(figures) > least; });
}

/// `columns` without repetitions of the same point; `first` gets for each column the one that stays.
std::vector<Index> withoutRepetitions(const Points& points, std::vector<Index> columns, std::vector<Index>& first)
{
  const auto key = [&](Index i) { return std::array{points(0, i), points(1, i), points(2, i)}; };
  std::sort(columns.begin(), columns.end(), [&](Index a, Index b) {
    const auto key_a = key(a), key_b = key(b);
    return key_a != key_b ? key_a < key_b : a < b;
  });
  std::vector<Index> single;
  for (const Index i : columns) {
    if (single.empty() || key(single.back()) != key(i))
      single.push_back(i);
    first[i] = single.back();
  }
  std::sort(single.begin(), single.end());
  return single;
}

/// Finite points grouped by equal viewpoints.
std::vector<std::vector<Index>> groupByViewpoint(const Points& points, const Points& viewpoints)
{
  std::vector<Index> finite;
  for (Index i = 0; i < points.cols(); ++i)
    if (points.col(i).allFinite())
      finite.push_back(i);
  if (viewpoints.cols() == 1)
    return {finite};
  const auto key = [&](Index i) { return std::array{viewpoints(0, i), viewpoints(1, i), viewpoints(2, i)}; };
  std::stable_sort(finite.begin(), finite.end(), [&](Index a, Index b) { return key(a) < key(b); });
  std::vector<std::vector<Index>> groups;
  for (const Index i : finite) {
    if (groups.empty() || key(groups.back().back()) != key(i))
      groups.emplace_back();
    groups.back().push_back(i);
  }
  return groups;
}

void validate(const Points& points, const Points& viewpoints, const VeilOptions& options)
{
  require(viewpoints.cols() == 1 || viewpoints.cols() == points.cols(), "veil points: ", viewpoints.cols(),
          " viewpoints for ", points.cols(), " points");
  require(viewpoints.allFinite(), "veil points: a viewpoint is not finite");
  require(options.angle > 0 && options.angle < 90, "veil points: angle ", options.angle, " is not in 0..90 degrees");
  require(options.noise >= 0 && std::isfinite(options.noise), "veil points: noise ", options.noise,
          " is negative or not finite");
  require(options.k >= 8 && options.k <= 64, "veil points: k ", options.k, " is not in 8..64");
}
} // namespace

std::vector<Index> withoutVeil(const Points& points, const Points& viewpoints, const VeilOptions& options)
{
  validate(points, viewpoints, options);
  std::vector<char> veil(points.cols(), 0);
  const auto groups = groupByViewpoint(points, viewpoints);
  std::vector<Index> first(points.cols(), -1);
  for (const auto& group : groups) {
    const std::vector<Index> single = withoutRepetitions(points, group, first);
    if (!single.empty())
      judge(makeBeamScan(points, viewpoints.col(viewpoints.cols() == 1 ? 0 : single.front()), single, options), options,
            veil);
  }
  std::vector<Index> kept;
  for (Index i = 0; i < points.cols(); ++i)
    if (first[i] >= 0 && veil[first[i]] == 0)
      kept.push_back(i);
  return kept;
}
} // namespace fresco
