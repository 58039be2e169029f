// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/low_pass_filter.h"
#include "poisson/octree/halo.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
/// Depths by which the samples' own depth lies below the level's: from here on waves are taken out, and this much
/// beyond at full strength; which is not all of a wave, because the samples that are there hold it too.
constexpr float first_lack = 0.75f, lack_range = 1.f, sparse_strength = 0.5f, most_lack = 3.f;
/// The same of the noise of the mean of the samples on one face of a cell, in cells.
constexpr float first_noise = 0.05f, noise_range = 0.05f;

/// Sums over the samples of a brick, weighted by their area.
struct BrickSums {
  float area = 0, lack = 0, noise = 0;
};

float strengthOf(const BrickSums& sums)
{
  if (sums.area <= 0.f)
    return sparse_strength;
  const float sparse = (sums.lack / sums.area - first_lack) / lack_range;
  const float noisy = (sums.noise / sums.area - first_noise) / noise_range;
  return std::max(sparse_strength * std::clamp(sparse, 0.f, 1.f), std::clamp(noisy, 0.f, 1.f));
}
} // namespace

WaveFilter::WaveFilter(const BrickLevel& level, const SampleLevel& samples, int finest, int threads)
    : level_(level), threads_(threads), strengths_(level.codes.size())
{
  const Array<std::uint32_t> begin = sampleRanges(level, samples.codes, samples.depth, threads);
  const float scale = std::ldexp(1.f, level.depth - finest);
  std::vector<BrickSums> sums(level.codes.size());
  parallelFor(level.size(), threads, [&](Index b) {
    const auto at = static_cast<std::size_t>(b);
    for (std::uint32_t i = begin[at]; i < begin[at + 1]; ++i) {
      const CoarseSample& s = samples.samples[i];
      sums[at].area += s.area;
      sums[at].lack += s.area * std::clamp(static_cast<float>(level.depth) - s.depth, -1.f, most_lack);
      sums[at].noise += s.area * s.noise * std::sqrt(s.area) * scale * scale;
    }
  });
  parallelFor(level.size(), threads, [&](Index b) {
    BrickSums around;
    for (const int n : level_.neighbors[b])
      if (n >= 0) {
        const BrickSums& part = sums[n];
        around = {around.area + part.area, around.lack + part.lack, around.noise + part.noise};
      }
    strengths_[b] = strengthOf(around);
  });
}

void WaveFilter::apply(NodeField& chi, NodeField& spare) const
{
  const auto isActive = [&](int b) { return b >= 0 && strengths_[b] > 0.f; };
  if (std::none_of(strengths_.begin(), strengths_.end(), [](float w) { return w > 0.f; }))
    return;
  parallelFor(level_.size(), threads_, [&](Index b) {
    float* to = spare.brick(b);
    std::memset(to, 0, brick_stride * sizeof(float));
    const auto& around = level_.neighbors[b];
    if (std::any_of(around.begin(), around.end(), isActive))
      addWaves(b, chi, 1.f, to);
  });
  syncFaces(level_, spare, threads_);
  parallelFor(level_.size(), threads_, [&](Index b) {
    if (isActive(static_cast<int>(b)))
      addWaves(b, spare, -strengths_[b], chi.brick(b));
  });
  syncFaces(level_, chi, threads_);
}

void WaveFilter::addWaves(Index brick, const NodeField& field, float factor, float* result) const
{
  float halo[halo_size];
  loadHalo(level_, brick, field, halo);
  const std::uint64_t fixed = fixedNodes(level_, brick);
  for (int y_z = 0; y_z < brick_cells * brick_cells; ++y_z) {
    const int y = y_z & 3, z = y_z >> 2;
    const float* at = halo + haloIndex(0, y, z);
    Line smooth{};
    for (int o = 0; o < 27; ++o)
      smooth += line(at + haloStep(o)) * (1.f / static_cast<float>(8 << axesOf(o)));
    for (int x = 0; x < brick_cells; ++x)
      if (!(fixed >> ownIndex(x, y, z) & 1))
        result[nodeIndex(x, y, z)] += factor * (at[x] - smooth[x]);
  }
}
} // namespace fresco::poisson
