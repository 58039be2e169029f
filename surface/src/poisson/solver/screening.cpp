// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/screening.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
Array<ScreenedSample> screenedSamples(const BrickLevel& level, const SampleLevel& samples, int finest,
                                      float point_weight, int threads)
{
  constexpr float most_faces = 64.f; // area of a sample three depths below what the data sustain; it holds no harder
  const float scale = std::ldexp(1.f, level.depth - finest);
  Array<ScreenedSample> screened(samples.samples.size());
  parallelFor(screened.size(), threads, [&](Index i) {
    const CoarseSample& s = samples.samples[i];
    const float isolated = std::clamp(level.depth + 1.f - s.depth, 0.f, 1.f);
    const float faces = std::min(s.area * scale * scale, most_faces);
    const float weight = point_weight * screeningWeight(s.noise * scale) * faces;
    screened[i] = {s.position * scale, weight, isolated};
  });
  return screened;
}
} // namespace fresco::poisson
