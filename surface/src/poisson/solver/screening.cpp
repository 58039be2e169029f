// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/screening.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
float softnessOf(float surplus, float noise)
{
  constexpr float first = 0.7f;      // samples per face of a cell from which on they hold harder
  constexpr float least = 0.2f;      // holding harder still brings out ripples of noise
  constexpr float tolerated = 0.04f; // noise at which nothing changes
  const float per_face = std::exp2(2.f * surplus);
  return std::clamp(first / per_face + noise * noise / (tolerated * tolerated), least, 1.f);
}

Array<float> screeningWeights(const SampleLevel& samples, float scale, float point_weight, int threads)
{
  constexpr float most_faces = 64.f;   // area of a sample three depths below what the data sustain; it holds no harder
  const bool is_finest = scale == 1.f; // coarser depths only begin what the finest ends
  Array<float> weights(samples.samples.size());
  parallelFor(weights.size(), threads, [&](Index i) {
    const CoarseSample& s = samples.samples[i];
    const float faces = std::min(s.area * scale * scale, most_faces);
    const float softness = is_finest ? softnessOf(s.depth - samples.depth, s.noise) : 1.f;
    weights[i] = point_weight * screeningWeight(s.noise * scale, softness) * faces;
  });
  return weights;
}
} // namespace fresco::poisson
