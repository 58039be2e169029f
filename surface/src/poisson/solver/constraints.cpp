// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/constraints.h"
#include "poisson/octree/splat.h"
#include "poisson/samples/shared_splat.h"
#include "poisson/solver/transfer.h"
#include <algorithm>
#include <fresco/core/machine_memory.h>
#include <utility>
namespace fresco::poisson {
namespace {
/// Share of a sample that is splatted at octree depth d: the two depths around its own share it.
float share(float sample_depth, int d, int finest)
{
  const float s = std::clamp<float>(sample_depth, 2, finest);
  return std::max(0.f, 1.f - std::abs(s - d));
}

struct NormalField {
  const SampleLevel& samples; ///< of the finest depth
  const Array<Eigen::Vector3f>& vectors;
};

/// @tparam Weights hat functions convolved with the kernel that spreads a sample
template <typename Weights>
void splatVector(const Eigen::Vector3f& n, const Eigen::Vector3f& position, SplatBlock<Weights::reach>& block)
{
  const Weights x(position.x()), y(position.y()), z(position.z());
  for (int c = 0; c < Weights::count; ++c)
    for (int r = 0; r < Weights::count; ++r) {
      const float along = n.x() * y.value[r] * z.value[c];
      const float across = n.y() * y.derivative[r] * z.value[c] + n.z() * y.value[r] * z.derivative[c];
      float* row = &block.at(x.first, y.first + r, z.first + c);
      for (int q = 0; q < Weights::count; ++q)
        row[q] += along * x.derivative[q] + across * x.value[q];
    }
}

/// Whether all ranks have all bricks of a depth, but not all samples.
bool isShared(const Octree& tree, int depth) { return tree.partition && !tree.isDivided(depth); }

/// Those that a rank splats: at shared depths each its own.
SampleRanges samplesOf(const Octree& tree, int depth, const SampleLevel& samples, int threads)
{
  SampleRanges ranges = sampleRanges(tree.levels[depth], samples.codes, samples.depth, threads);
  if (isShared(tree, depth)) {
    const auto own = tree.partition->ownRange(samples.depth, samples.codes);
    for (std::uint32_t& begin : ranges.begin)
      begin = std::clamp<Index>(begin, own.first, own.second);
  }
  return ranges;
}

template <typename Weights>
void splatLevel(const Octree& tree, int depth, const NormalField& normals, NodeField& field, int threads)
{
  const BrickLevel& level = tree.levels[depth];
  const SampleLevel& samples = normals.samples;
  const int finest = samples.depth;
  const SampleRanges ranges = samplesOf(tree, depth, samples, threads);
  const float scale = std::ldexp(1.f, level.depth - finest);
  const auto splat = [&](SplatBlock<Weights::reach>& block, int b) {
    const Eigen::Vector3f origin = level.origin(b);
    for (const std::uint32_t i : ranges[b]) {
      const CoarseSample& s = samples.samples[i];
      const float w = share(s.depth, level.depth, finest);
      if (w > 0.f)
        splatVector<Weights>(w * s.area * scale * scale * normals.vectors[i], s.position * scale - origin, block);
    }
  };
  if (isShared(tree, depth))
    SharedSplat<Weights::reach>(level, ranges, tree.exchange(), threads).addTo(field, splat);
  else
    splatBricks<Weights::reach>(level, ranges, field, threads, splat);
  refreshGhosts(level, field);
}
} // namespace

Constraints splatNormals(const Octree& tree, const SampleLevel& samples, Array<Eigen::Vector3f>&& normals, int threads)
{
  Array<Eigen::Vector3f> vectors = std::move(normals);
  Constraints constraints;
  constraints.fine.resize(tree.levels.size());
  constraints.own.resize(tree.levels.size());
  const auto splatted = [&](int d) {
    NodeField field(tree.levels[d], threads);
    if (d < tree.depth)
      splatLevel<BoxWeights>(tree, d, {samples, vectors}, field, threads);
    else
      splatLevel<TentWeights>(tree, d, {samples, vectors}, field, threads);
    return field;
  };
  for (int d = 2; d < tree.depth; ++d)
    constraints.own[d] = splatted(d);
  constraints.fine[tree.depth] = splatted(tree.depth);
  releaseMemory(vectors);
  for (int d = tree.depth - 1; d >= 2; --d) {
    NodeField& finer = constraints.fine[d + 1];
    constraints.fine[d] = constraints.own[d].copy(threads);
    restrictLevel(tree.levels[d + 1], finer, tree.levels[d], 0.5f, constraints.fine[d], threads);
    if (d + 1 > tree.full_depth)
      finer.releaseRim();
    poisonGhosts(tree.levels[d + 1], finer); // right-hand sides are read in own bricks only
  }
  return constraints;
}

void addCoarser(const Octree& tree, int depth, int threads, Constraints& constraints)
{
  if (depth == 2)
    return;
  // Per unit volume the interpolated density is the same; a cell has 1/8 of the volume and 1/2 of the side.
  constexpr float factor = 0.25f;
  const BrickLevel& level = tree.levels[depth];
  interpolateLevel(tree, depth, constraints.own[depth - 1], threads, [&](Index b, const float* values) {
    constraints.fine[depth].add(level, b, factor, values);
    if (depth < tree.depth)
      constraints.own[depth].add(level, b, factor, values);
  });
  constraints.own[depth - 1] = NodeField();
}
} // namespace fresco::poisson
