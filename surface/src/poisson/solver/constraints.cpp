// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/constraints.h"
#include "poisson/octree/splat.h"
#include "poisson/solver/transfer.h"
#include <algorithm>
#include <cstring>
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

template <typename Weights>
void splatLevel(const BrickLevel& level, const NormalField& normals, NodeField& field, int threads)
{
  const SampleLevel& samples = normals.samples;
  const int finest = samples.depth;
  const Array<std::uint32_t> begin = sampleRanges(level, samples.codes, finest, threads);
  const float scale = std::ldexp(1.f, level.depth - finest);
  splatBricks<Weights::reach>(level, begin, field, threads, [&](SplatBlock<Weights::reach>& block, int b) {
    const Eigen::Vector3f origin = level.origin(b);
    for (std::uint32_t i = begin[b]; i < begin[b + 1]; ++i) {
      const CoarseSample& s = samples.samples[i];
      const float w = share(s.depth, level.depth, finest);
      if (w > 0.f)
        splatVector<Weights>(w * s.area * scale * scale * normals.vectors[i], s.position * scale - origin, block);
    }
  });
  sumFaces(level, field, threads);
}

NodeField copyOf(const NodeField& field, int threads)
{
  NodeField copy(field.size());
  parallelRanges(field.size(), threads, [&](Index begin, Index end) {
    std::memcpy(copy.brick(begin), field.brick(begin), (end - begin) * brick_stride * sizeof(float));
  });
  return copy;
}
} // namespace

Constraints splatNormals(const Octree& tree, const SampleLevel& samples, const Array<Eigen::Vector3f>& normals,
                         int threads)
{
  const NormalField normal_field{samples, normals};
  Constraints constraints;
  constraints.fine.resize(tree.levels.size());
  constraints.own.resize(tree.levels.size());
  for (int d = tree.depth; d >= 2; --d) {
    const BrickLevel& level = tree.levels[d];
    NodeField& field = constraints.fine[d];
    field = NodeField(level.size(), threads);
    if (d == tree.depth) {
      splatLevel<TentWeights>(level, normal_field, field, threads);
      continue;
    }
    splatLevel<BoxWeights>(level, normal_field, field, threads);
    constraints.own[d] = copyOf(field, threads);
    restrictLevel(tree.levels[d + 1], constraints.fine[d + 1], level, 0.5f, field, threads);
  }
  return constraints;
}

void addCoarser(const Octree& tree, int depth, int threads, Constraints& constraints)
{
  if (depth == 2)
    return;
  const BrickLevel& level = tree.levels[depth];
  const NodeField& coarse = constraints.own[depth - 1];
  parallelFor(level.size(), threads, [&](Index b) {
    float values[brick_stride] = {};
    interpolateToChild(coarse.brick(level.parents[b]), level.octant(b), values);
    // Per unit volume the interpolated density is the same; a cell has 1/8 of the volume and 1/2 of the side.
    for (int k = 0; k < nodes_per_brick; ++k) {
      constraints.fine[depth].brick(b)[k] += 0.25f * values[k];
      if (depth < tree.depth)
        constraints.own[depth].brick(b)[k] += 0.25f * values[k];
    }
  });
  constraints.own[depth - 1] = NodeField();
}
} // namespace fresco::poisson
