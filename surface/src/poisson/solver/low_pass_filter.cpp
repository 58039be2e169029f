// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/low_pass_filter.h"
#include "poisson/octree/halo.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
/// Sums over the samples of a brick, weighted by their area.
struct BrickSums {
  float area = 0;
  float missing_depth = 0; ///< depths by which the samples' own depth lies below the level's
  float noise = 0;         ///< of the mean of the samples on one face of a cell, in cells
};

/// 0 up to the first value, full one depth further and from twice the noise on. Measured on fandisk, igea and a room.
float strengthOf(const BrickSums& sums)
{
  constexpr float first_missing = 0.75f;  // depths
  constexpr float first_noise = 0.05f;    // cells
  constexpr float sparse_strength = 0.5f; // not all of a wave, because the samples that are there hold it, too
  if (sums.area <= 0.f)
    return sparse_strength;
  const float sparse = sums.missing_depth / sums.area - first_missing;
  const float noisy = sums.noise / sums.area / first_noise - 1;
  return std::max(sparse_strength * std::clamp(sparse, 0.f, 1.f), std::clamp(noisy, 0.f, 1.f));
}
} // namespace

LowPassFilter::LowPassFilter(const BrickLevel& level, const SampleLevel& samples, int finest, int threads)
    : level_(level), threads_(threads), strengths_(level.codes.size())
{
  const SampleRanges ranges = sampleRanges(level, samples.codes, samples.depth, threads);
  const float scale = std::ldexp(1.f, level.depth - finest);
  std::vector<BrickSums> sums(level.codes.size());
  parallelFor(level.size(), threads, [&](Index b) {
    for (const std::uint32_t i : ranges[b]) {
      const CoarseSample& s = samples.samples[i];
      sums[b].area += s.area;
      sums[b].missing_depth += s.area * std::max(level.depth - s.depth, -1.f);
      sums[b].noise += s.area * s.noise * std::sqrt(s.area) * scale * scale;
    }
  });
  parallelFor(level.size(), threads, [&](Index b) {
    BrickSums around;
    for (const int n : level_.neighborsOf(b))
      if (n >= 0) {
        const BrickSums& part = sums[n];
        around = {around.area + part.area, around.missing_depth + part.missing_depth, around.noise + part.noise};
      }
    strengths_[b] = strengthOf(around);
  });
  level.ghosts.refresh(strengths_.data());
}

void LowPassFilter::apply(NodeField& chi, NodeField& spare) const
{
  const auto isActive = [&](Index b) { return b >= 0 && strengths_[b] > 0.f; };
  std::int64_t active = std::any_of(strengths_.begin(), strengths_.end(), [](float w) { return w > 0.f; }) ? 1 : 0;
  if (level_.ghosts.isDivided())
    level_.ghosts.exchange->sum(&active, 1);
  if (active == 0)
    return;
  spare.releaseRim();
  parallelFor(level_.size(), threads_, [&](Index b) {
    float* to = spare.own(b);
    std::fill_n(to, own_nodes, 0.f);
    const Neighbors around = level_.neighborsOf(b);
    if (std::any_of(around.begin(), around.end(), isActive))
      addHighPass(around, chi, 1.f, to);
  });
  refreshOwnNodes(level_, spare);
  parallelFor(level_.size(), threads_, [&](Index b) {
    if (isActive(b))
      addHighPass(level_.neighborsOf(b), spare, -strengths_[b], chi.own(b));
  });
  refreshGhosts(level_, chi);
}

void LowPassFilter::addHighPass(const Neighbors& neighbors, const NodeField& field, float factor, float* result) const
{
  float halo[halo_size];
  loadHalo(level_, neighbors, field, halo);
  const std::uint64_t fixed = fixedNodes(neighbors);
  for (int y_z = 0; y_z < brick_cells * brick_cells; ++y_z) {
    const int y = y_z & 3, z = y_z >> 2;
    const float* at = halo + haloIndex(0, y, z);
    Line smooth{};
    for (int o = 0; o < 27; ++o)
      smooth += line(at + haloStep(o)) * (1.f / (8 << axesOf(o)));
    for (int x = 0; x < brick_cells; ++x)
      if (!(fixed >> ownIndex(x, y, z) & 1))
        result[ownIndex(x, y, z)] += factor * (at[x] - smooth[x]);
  }
}
} // namespace fresco::poisson
