// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/noise.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
#include <iterator>
#include <vector>
namespace fresco::poisson {
namespace {
/// Samples along the curve that share an estimate: some 600 pairs for two medians, and still local.
constexpr Index run_length = 256;

/// What the samples of a run lie off each other's tangent planes. The variances are divided by the squared distance of
/// close pairs, so that dense and sparse runs next to each other can be averaged.
struct Offsets {
  double close = 0;            ///< variance, of the closest third of the pairs
  double distant = 0;          ///< of the most distant third, about three times as far apart
  double squared_distance = 0; ///< median of the closest third, along the surface, in squared finest cells
  Index pairs = 0;
};

struct Pair {
  float squared_distance; ///< along the surface, which noise does not lengthen
  float offset;           ///< across
  bool alike;             ///< the normals differ by less than 25 degrees
};

using Pairs = std::vector<Pair>;

/// Pairs of samples begin..end - 1 with those that follow them.
Pairs pairsOfRun(const Array<Sample>& samples, Index begin, Index end)
{
  constexpr Index partners = 12, step = 5; // every fifth sample with the next twelve: enough pairs, near and far
  constexpr float least_cosine = 0.9f;
  Pairs pairs;
  for (Index i = begin; i < end; i += step)
    for (Index j = i + 1; j <= i + partners && j < end; ++j) {
      const Sample &a = samples[i], &b = samples[j];
      const Eigen::Vector3f apart = b.position - a.position;
      const float reach = 3.f * std::sqrt(a.area + b.area) + 3.f, squared = apart.squaredNorm();
      if (squared > reach * reach)
        continue;
      const float offset = std::abs(apart.dot(a.normal + b.normal)) * 0.5f;
      const bool alike = a.normal.dot(b.normal) > least_cosine;
      pairs.push_back({alike ? std::max(0.f, squared - offset * offset) : squared, offset, alike});
    }
  return pairs;
}

double variance(Pairs::const_iterator begin, Pairs::const_iterator end)
{
  constexpr double median_of_difference = 0.6745 * 1.41421356; // of |a - b|, a and b normally distributed, sigma 1
  std::vector<float> offsets;
  std::transform(begin, end, std::back_inserter(offsets), [](const Pair& pair) { return pair.offset; });
  return std::pow(median(offsets) / median_of_difference, 2);
}

/// Close pairs across an edge are left out. Distant ones count: where there are many, there is more shape than the
/// samples can tell from noise.
Offsets offsetsOfRun(const Array<Sample>& samples, Index begin, Index end)
{
  constexpr std::ptrdiff_t least_pairs = 8; // for a median
  constexpr float least_squared_distance = 1e-3f;
  const auto isCloser = [](const Pair& a, const Pair& b) { return a.squared_distance < b.squared_distance; };
  Pairs pairs = pairsOfRun(samples, begin, end);
  const std::ptrdiff_t third = pairs.size() / 3;
  if (third < least_pairs)
    return {};
  const auto close_end = pairs.begin() + third, distant = pairs.end() - third;
  std::nth_element(pairs.begin(), close_end, pairs.end(), isCloser);
  std::nth_element(close_end, distant, pairs.end(), isCloser);
  std::nth_element(pairs.begin(), pairs.begin() + third / 2, close_end, isCloser);
  const double squared = std::max(least_squared_distance, pairs[third / 2].squared_distance);
  const auto alike_end = std::partition(pairs.begin(), close_end, [](const Pair& pair) { return pair.alike; });
  if (alike_end - pairs.begin() < least_pairs)
    return {};
  return {variance(pairs.begin(), alike_end) / squared, variance(distant, pairs.end()) / squared, squared,
          static_cast<Index>(pairs.size())};
}

/// Noise is the same at all distances. What grows with the distance is the shape of the surface, and smoothing would
/// take that away, too: noise counts as far as it is larger than what the offsets grow by.
/// @param around the runs whose offsets count for run `own`
float noiseOf(const Offsets& own, const std::array<Offsets, 3>& around)
{
  constexpr double errors_of_normals = 6.0; // distant / close where nothing but noise bends the normals, at most
  double close = 0, distant = 0, pairs = 0;
  for (const Offsets& run : around) {
    close += run.pairs * run.close;
    distant += run.pairs * run.distant;
    pairs += run.pairs;
  }
  const double growth = std::max(0.0, distant - errors_of_normals * close);
  return pairs > 0 ? std::sqrt(own.squared_distance * std::max(0.0, close - growth) / pairs) : 0.0;
}
} // namespace

void estimateNoise(Samples& samples, int threads)
{
  constexpr float tolerated_mean_noise = 1.f; // of a cell's samples, in cells; less costs detail: docs/measurements
  const Index n = samples.samples.size();
  std::vector<Offsets> runs((n + run_length - 1) / run_length);
  parallelRanges(
      n, threads, [&](Index begin, Index end) { runs[begin / run_length] = offsetsOfRun(samples.samples, begin, end); },
      run_length);
  const float finest = samples.cube.depth;
  parallelFor(n, threads, [&](Index i) {
    const Index run = i / run_length, last = runs.size() - 1;
    Sample& s = samples.samples[i];
    s.noise = noiseOf(runs[run], {runs[std::max<Index>(run - 1, 0)], runs[run], runs[std::min(run + 1, last)]});
    const float cell_squared = s.noise * std::sqrt(s.area) / tolerated_mean_noise;
    s.depth = std::min(s.depth, finest - 0.5f * std::log2(std::max(cell_squared, 1e-6f)));
  });
}
} // namespace fresco::poisson
