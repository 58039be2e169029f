// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/noise.h"
#include "poisson/octree/bytes.h"
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

/// What the samples of a run lie off planes through each other. The variances are divided by the squared distance of
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

/// Samples begin..end - 1 of a run, some of them with those that follow them.
Pairs pairsOfRun(const Array<Sample>& samples, Index begin, Index end)
{
  constexpr Index partners = 12, step = 5; // every fifth sample with the next twelve: enough pairs, near and far
  constexpr float least_cosine = 0.9f;
  const auto isAlike = [&](Index i, Index j) { return samples[i].normal.dot(samples[j].normal) > least_cosine; };
  Pairs pairs;
  for (Index i = begin; i < end; i += step) {
    // Across the mean of the normals around: the errors of two normals would count as shape, which grows with distance.
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    for (Index j = std::max(begin, i - partners / 2); j <= i + partners / 2 && j < end; ++j)
      if (isAlike(i, j))
        normal += samples[j].normal;
    normal.normalize();
    for (Index j = i + 1; j <= i + partners && j < end; ++j) {
      const Sample &a = samples[i], &b = samples[j];
      const Eigen::Vector3f apart = b.position - a.position;
      const float reach = 3.f * std::sqrt(a.area + b.area) + 3.f, squared = apart.squaredNorm();
      if (squared > reach * reach)
        continue;
      const float offset = std::abs(apart.dot(normal));
      const bool alike = isAlike(i, j);
      pairs.push_back({alike ? std::max(0.f, squared - offset * offset) : squared, offset, alike});
    }
  }
  return pairs;
}

double variance(Pairs::const_iterator begin, Pairs::const_iterator end)
{
  std::vector<float> offsets;
  std::transform(begin, end, std::back_inserter(offsets), [](const Pair& pair) { return pair.offset; });
  return std::pow(mad_to_sigma * median(offsets), 2) / 2; // of |a - b|, a and b normally distributed
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
/// What the runs lie off, of the samples of all ranks behind each other: those that begin among the own samples, and
/// those next to them.
class Runs {
public:
  Runs(const Array<Sample>& samples, Exchange& exchange, int threads)
  {
    const Index n = samples.size();
    first_sample_ = exchange.sumBefore(n);
    first_ = (first_sample_ + run_length - 1) / run_length;
    last_ = (sumOfAll(exchange, n) - 1) / run_length;
    const Index begin = first_ * run_length - first_sample_; // of the first run, which may lie behind all own samples
    offsets_.resize(begin < n ? (n - begin + run_length - 1) / run_length : 0);
    const Array<Sample> cut = lastRun(samples, begin, exchange);
    parallelFor(
        offsets_.size(), threads,
        [&](Index r) {
          const Index from = begin + r * run_length;
          offsets_[r] =
              from + run_length > n ? offsetsOfRun(cut, 0, cut.size()) : offsetsOfRun(samples, from, from + run_length);
        },
        1);
    if (exchange.size() > 1)
      addNeighbors(exchange);
  }

  Index firstSample() const { return first_sample_; }
  Index last() const { return last_; }
  const Offsets& operator[](Index run) const { return offsets_[run - first_]; }

private:
  /// Samples of the run that the end of the own ones cuts, also those of higher ranks; empty if there is none.
  static Array<Sample> lastRun(const Array<Sample>& samples, Index begin, Exchange& exchange)
  {
    const Index n = samples.size();
    Array<Sample> cut;
    if (begin < n)
      cut.assign(samples.end() - (n - begin) % run_length, samples.end());
    if (exchange.size() == 1)
      return cut;
    Bytes message;
    append(message, samples.data(), std::min(n, run_length - 1));
    const std::vector<Bytes> heads = exchange.gatherAll(std::move(message));
    for (int r = exchange.rank() + 1; r < exchange.size() && !cut.empty(); ++r)
      appendTo(cut, heads[r]);
    cut.resize(std::min<Index>(cut.size(), run_length));
    return cut;
  }

  /// The two runs before the own ones and the one behind them, which count for own samples, too.
  void addNeighbors(Exchange& exchange)
  {
    struct Numbered {
      Index run;
      Offsets offsets;
    };
    std::vector<Numbered> ends;
    const Index n = offsets_.size();
    for (Index r = 0; r < n; ++r)
      if (r < 1 || r + 2 >= n)
        ends.push_back({first_ + r, offsets_[r]});
    const Array<Numbered> all = gatherAll(exchange, ends.data(), ends.size());
    const Index from = std::max<Index>(first_ - 2, 0), to = std::min(first_ + n, last_);
    std::vector<Offsets> extended(to + 1 - from);
    std::copy(offsets_.begin(), offsets_.end(), extended.begin() + (first_ - from));
    for (const Numbered& other : all)
      if (other.run >= from && other.run <= to)
        extended[other.run - from] = other.offsets;
    offsets_ = std::move(extended);
    first_ = from;
  }

  Index first_sample_ = 0, first_ = 0, last_ = 0; ///< `first_` of offsets_
  std::vector<Offsets> offsets_;
};
} // namespace

void estimateNoise(Samples& samples, Exchange& exchange, int threads)
{
  const Runs runs(samples.samples, exchange, threads);
  const float finest = samples.cube.depth;
  parallelFor(samples.samples.size(), threads, [&](Index i) {
    const Index run = (runs.firstSample() + i) / run_length, last = runs.last();
    Sample& s = samples.samples[i];
    s.noise = noiseOf(runs[run], {runs[std::max<Index>(run - 1, 0)], runs[run], runs[std::min(run + 1, last)]});
    const float cell_squared = s.noise * std::sqrt(s.area); // with a mean noise of one cell; less costs detail
    s.depth = std::min(s.depth, finest - 0.5f * std::log2(std::max(cell_squared, 1e-6f)));
  });
}
} // namespace fresco::poisson
