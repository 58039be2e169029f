// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/noise.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
namespace fresco::poisson {
namespace {
/// Samples along the curve that share an estimate: some 200 pairs for a median, and still local.
constexpr Index run_length = 64;

/// Standard deviation across the surface, in finest cells, over samples begin..end - 1; 0 where few can be compared.
float noiseOfRun(const Array<Sample>& samples, Index begin, Index end)
{
  constexpr Index partners = 3;        // following samples that a sample is compared with: mostly its neighbours
  constexpr float least_cosine = 0.9f; // of their normals: 25 degrees keep pairs across an edge out
  constexpr std::size_t least_pairs = 8;
  constexpr float median_of_difference = 0.6745f * 1.41421356f; // of |a - b|, a and b normally distributed, sigma 1
  std::vector<float> offsets;
  for (Index i = begin; i < end; ++i)
    for (Index j = i + 1; j <= i + partners && j < end; ++j) {
      const Sample &a = samples[i], &b = samples[j];
      const Eigen::Vector3f apart = b.position - a.position;
      const float reach = 3.f * std::sqrt(a.area + b.area) + 3.f;
      if (a.normal.dot(b.normal) > least_cosine && apart.squaredNorm() < reach * reach)
        offsets.push_back(std::abs(apart.dot(a.normal + b.normal)) * 0.5f);
    }
  if (offsets.size() < least_pairs)
    return 0.f;
  return median(offsets) / median_of_difference;
}
} // namespace

void estimateNoise(Samples& samples, int threads)
{
  constexpr float tolerated_mean_noise = 0.6f; // of a cell's samples, in cells; 0.2 cost detail, see docs/measurements
  const Index n = samples.samples.size();
  std::vector<float> noise((n + run_length - 1) / run_length);
  parallelRanges(
      n, threads, [&](Index begin, Index end) { noise[begin / run_length] = noiseOfRun(samples.samples, begin, end); },
      run_length);
  const float finest = samples.cube.depth;
  parallelFor(n, threads, [&](Index i) {
    const Index run = i / run_length, last = noise.size() - 1;
    float sum = 0;
    for (const Index r : {std::max<Index>(run - 1, 0), run, std::min(run + 1, last)})
      sum += noise[r] * noise[r] / 3.f;
    Sample& s = samples.samples[i];
    s.noise = std::sqrt(sum);
    const float cell_squared = s.noise * std::sqrt(s.area) / tolerated_mean_noise;
    s.depth = std::min(s.depth, finest - 0.5f * std::log2(std::max(cell_squared, 1e-6f)));
  });
}
} // namespace fresco::poisson
