// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/constraints.h"
#include "poisson/octree/splat.h"
#include "poisson/solver/transfer.h"
#include <algorithm>
#include <cstring>
namespace fresco::poisson {
namespace {
/// Share of a sample that is splatted at octree depth d: the two depths around
/// its own share it.
float share(float sample_depth, int d, int finest)
{
  const float s = std::clamp(sample_depth, 2.f, static_cast<float>(finest));
  return std::max(0.f, 1.f - std::abs(s - static_cast<float>(d)));
}

/// @tparam Weights hat functions convolved with the kernel that spreads a sample
template <typename Weights>
void splatSample(const Sample& s, float factor, const Eigen::Vector3f& position, SplatBlock<Weights::reach>& block)
{
  const Weights x(position.x()), y(position.y()), z(position.z());
  const Eigen::Vector3f n = factor * s.normal;
  for (int c = 0; c < Weights::count; ++c)
    for (int r = 0; r < Weights::count; ++r) {
      const auto i = static_cast<std::size_t>(r), k = static_cast<std::size_t>(c);
      const float along = n.x() * y.value[i] * z.value[k];
      const float across = n.y() * y.slope[i] * z.value[k] + n.z() * y.value[i] * z.slope[k];
      float* row = &block.at(x.first, y.first + r, z.first + c);
      for (std::size_t q = 0; q < Weights::count; ++q)
        row[q] += along * x.slope[q] + across * x.value[q];
    }
}

template <typename Weights>
void splatLevel(const BrickLevel& level, const Samples& samples, NodeField& field, int threads)
{
  const int finest = samples.cube.depth;
  const Array<std::uint32_t> begin = sampleRanges(level, samples.codes, finest, threads);
  const float scale = std::ldexp(1.f, level.depth - finest);
  splatBricks<Weights::reach>(level, begin, field, threads, [&](SplatBlock<Weights::reach>& block, int b) {
    const Eigen::Vector3f origin = level.origin(b);
    for (std::uint32_t i = begin[b]; i < begin[static_cast<std::size_t>(b) + 1]; ++i) {
      const Sample& s = samples.samples[i];
      const float w = share(s.depth, level.depth, finest);
      if (w > 0.f)
        splatSample<Weights>(s, w * s.area * scale * scale, s.position * scale - origin, block);
    }
  });
  sumFaces(level, field, threads);
}

NodeField copyOf(const NodeField& field, int threads)
{
  NodeField copy(field.size());
  parallelRanges(field.size(), threads, [&](Index begin, Index end) {
    std::memcpy(copy.brick(begin), field.brick(begin),
                static_cast<std::size_t>(end - begin) * brick_stride * sizeof(float));
  });
  return copy;
}
} // namespace

Constraints splatNormals(const Octree& tree, const Samples& samples, int threads)
{
  Constraints constraints;
  constraints.fine.resize(tree.levels.size());
  constraints.own.resize(tree.levels.size());
  for (int d = tree.depth; d >= 2; --d) {
    const auto i = static_cast<std::size_t>(d);
    const BrickLevel& level = tree.levels[i];
    NodeField& field = constraints.fine[i];
    field = NodeField(level.size(), threads);
    if (d == tree.depth) {
      splatLevel<TentWeights>(level, samples, field, threads);
      continue;
    }
    splatLevel<BoxWeights>(level, samples, field, threads);
    constraints.own[i] = copyOf(field, threads);
    restrictLevel(tree.levels[i + 1], constraints.fine[i + 1], level, 0.5f, field, threads);
  }
  return constraints;
}

void addCoarser(const Octree& tree, int depth, int threads, Constraints& constraints)
{
  const auto d = static_cast<std::size_t>(depth);
  if (depth == 2)
    return;
  const BrickLevel& level = tree.levels[d];
  const NodeField& coarse = constraints.own[d - 1];
  parallelFor(level.size(), threads, [&](Index b) {
    float values[brick_stride] = {};
    const auto i = static_cast<std::size_t>(b);
    interpolateToChild(coarse.brick(level.parents[i]), static_cast<int>(level.codes[i] & 7), values);
    // Per unit volume the interpolated density is the same; a cell has 1/8 of
    // the volume and 1/2 of the side.
    for (int k = 0; k < brick_nodes * brick_nodes * brick_nodes; ++k) {
      constraints.fine[d].brick(b)[k] += 0.25f * values[k];
      if (depth < tree.depth)
        constraints.own[d].brick(b)[k] += 0.25f * values[k];
    }
  });
  constraints.own[d - 1] = NodeField();
}
} // namespace fresco::poisson
