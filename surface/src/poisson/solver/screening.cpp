// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/screening.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
Array<float> screeningWeights(const SampleLevel& samples, float scale, float point_weight, int threads)
{
  constexpr float most_faces = 64.f; // area of a sample three depths below what the data sustain; it holds no harder
  Array<float> weights(samples.samples.size());
  parallelFor(weights.size(), threads, [&](Index i) {
    const CoarseSample& s = samples.samples[i];
    const float faces = std::min(s.area * scale * scale, most_faces);
    weights[i] = point_weight * screeningWeight(s.noise * scale) * faces;
  });
  return weights;
}
} // namespace fresco::poisson
