// SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels/mixed_pixel_score.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/point_set.h>
#include <fresco/core/require.h>
#include <fresco/filters/core/mixed_pixels.h>
namespace fresco {
using namespace filters;
namespace {

/// Marks the columns of mixed pixels.
void judge(BeamScan scan, const MixedPixelOptions& options, std::vector<char>& mixed)
{
  if (scan.columns.size() <= nearby_beams) // too few to be judged
    return;
  if (options.noise > 0)
    scan.noise = {{0}, {options.noise}};
  else
    scan.noise = measureNoise(scan, options.threads);
  const std::vector<float> scores = firstStageScores(scan, options);
  // Log odds: more likely in the air than not. Beams that overlap tell so much that with -1 few points are taken wrongly.
  const float least = scan.thinned ? -1.f : 0.f;
  forSecondStage(scan, options, scores, [&](Index i, const SecondStageFeatures& features) {
    mixed[scan.columns[i]] = mixedPixelScore(features) > least;
  });
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
  std::vector<Index> finite = finiteColumns(points);
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

void validate(const Points& points, const Points& viewpoints, const MixedPixelOptions& options)
{
  require(viewpoints.cols() == 1 || viewpoints.cols() == points.cols(), "mixed pixels: ", viewpoints.cols(),
          " viewpoints for ", points.cols(), " points");
  require(viewpoints.allFinite(), "mixed pixels: a viewpoint is not finite");
  require(options.angle > 0 && options.angle < 90, "mixed pixels: angle ", options.angle, " is not in 0..90 degrees");
  require(options.noise >= 0 && std::isfinite(options.noise), "mixed pixels: noise ", options.noise,
          " is negative or not finite");
  require(options.k >= 8 && options.k <= most_beams, "mixed pixels: k ", options.k, " is not in 8..64");
}
} // namespace

std::vector<Index> withoutMixedPixels(const Points& points, const Points& viewpoints, const MixedPixelOptions& options,
                                      const Progress& progress)
{
  validate(points, viewpoints, options);
  std::vector<char> mixed(points.cols(), 0);
  const auto groups = groupByViewpoint(points, viewpoints);
  std::vector<Index> first(points.cols(), -1);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    report(progress, "judge points", 1.0 * g / groups.size());
    const std::vector<Index> single = withoutRepetitions(points, groups[g], first);
    if (!single.empty())
      judge(makeBeamScan(points, viewpoints.col(viewpoints.cols() == 1 ? 0 : single.front()), single, options), options,
            mixed);
  }
  std::vector<Index> kept;
  for (Index i = 0; i < points.cols(); ++i)
    if (first[i] >= 0 && mixed[first[i]] == 0)
      kept.push_back(i);
  return kept;
}
} // namespace fresco
