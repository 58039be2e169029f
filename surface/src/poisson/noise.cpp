// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/noise.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
constexpr Index run_length = 64;
constexpr Index partners = 3; ///< following samples that a sample is compared with
/// Normals of compared samples differ by at most 25 degrees (cosine).
constexpr float least_cosine = 0.9f;
/// Noise of the mean of the samples in a cell, in cells, that the normal field
/// is meant to have at most.
constexpr float tolerated_mean_noise = 0.6f;
/// Median of |a - b| of two normal distributions in standard deviations of one.
constexpr float median_of_difference = 0.6745f * 1.41421356f;

/// Standard deviation across the surface, in finest cells, over samples
/// begin..end - 1.
float noiseOfRun(const Array<Sample>& samples, Index begin, Index end)
{
  std::vector<float> offsets;
  for (Index i = begin; i < end; ++i)
    for (Index j = i + 1; j <= i + partners && j < end; ++j) {
      const Sample &a = samples[i], &b = samples[j];
      const Eigen::Vector3f apart = b.position - a.position;
      const float reach = 3.f * std::sqrt(a.area + b.area) + 3.f;
      if (a.normal.dot(b.normal) > least_cosine && apart.squaredNorm() < reach * reach)
        offsets.push_back(std::abs(apart.dot(a.normal + b.normal)) * 0.5f);
    }
  if (offsets.size() < 8)
    return 0.f;
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  return *middle / median_of_difference;
}
} // namespace

void estimateNoise(Samples& samples, int threads)
{
  const auto n = static_cast<Index>(samples.samples.size());
  std::vector<float> noise((n + run_length - 1) / run_length);
  parallelRanges(
      n, threads, [&](Index begin, Index end) { noise[begin / run_length] = noiseOfRun(samples.samples, begin, end); },
      run_length);
  const auto finest = static_cast<float>(samples.cube.depth);
  parallelFor(n, threads, [&](Index i) {
    const Index run = i / run_length, last = static_cast<Index>(noise.size()) - 1;
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
