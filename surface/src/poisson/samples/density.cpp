// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/density.h"
#include "poisson/octree/splat.h"
#include "poisson/samples/sample_ghosts.h"
#include <algorithm>
namespace fresco::poisson {
namespace {
void splatWeights(const BrickLevel& level, const SampleLevel& samples, int finest, NodeField& field, int threads)
{
  const SampleRanges ranges = sampleRanges(level, samples.codes, samples.depth, threads);
  const float scale = std::ldexp(1.f, level.depth - finest);
  splatBricks(level, ranges, field, threads, [&](SplatBlock<1>& block, int b) {
    const Eigen::Vector3f origin = level.origin(b);
    for (const std::uint32_t i : ranges[b]) {
      const CoarseSample& s = samples.samples[i];
      const QuadraticWeights x(s.position.x() * scale - origin.x());
      const QuadraticWeights y(s.position.y() * scale - origin.y());
      const QuadraticWeights z(s.position.z() * scale - origin.z());
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
          const float w = s.area * z.value[c] * y.value[r];
          for (int q = 0; q < 3; ++q)
            block.at(x.first + q, y.first + r, z.first + c) += w * x.value[q];
        }
    }
  });
}
} // namespace

Density::Density(const Octree& tree, const Samples& samples, int threads) : tree_(&tree)
{
  fields_.resize(tree.levels.size());
  SampleLevel level = finestLevel(samples, threads);
  SampleGhosts(tree, level.codes, threads).addTo(level);
  for (int d = std::max(2, tree.depth - 1); d >= 2; --d) {
    const BrickLevel& bricks = tree.levels[d];
    NodeField& field = fields_[d];
    field = NodeField(bricks, threads);
    splatWeights(bricks, level, tree.depth, field, threads);
    refreshGhosts(bricks, field);
    level = coarsen(level, tree, threads);
  }
}

Density::Reader::Reader(const Density& density) : density_(density), windows_(density.fields_.size()) {}

void Density::Reader::load(int depth, Index brick)
{
  const BrickLevel& level = density_.tree_->levels[depth];
  const NodeField& field = density_.fields_[depth];
  const Neighbors neighbors = level.neighborsOf(brick);
  Window& window = windows_[depth];
  window.brick = brick;
  float* to = window.weights;
  for (int z = -1; z <= brick_nodes; ++z)
    for (int y = -1; y <= brick_nodes; ++y)
      for (int x = -1; x <= brick_nodes; ++x) {
        const int owner = neighbors[offsetIndex(x >> 2, y >> 2, z >> 2)];
        const NodePlace place = owner >= 0 ? NodePlace{owner * own_nodes + ownIndex(x & 3, y & 3, z & 3), -1}
                                           : findNode(level, brick, x, y, z);
        *to++ = std::max(place.own, place.rim) >= 0 ? field.at(place) : 0.f;
      }
}

float Density::Reader::weightAt(int depth, Index brick, const Eigen::Vector3f& position)
{
  if (windows_[depth].brick != brick)
    load(depth, brick);
  const float scale = std::ldexp(1.f, depth - density_.tree_->depth);
  const Eigen::Vector3f local = position * scale - density_.tree_->levels[depth].origin(brick);
  const QuadraticWeights x(local.x()), y(local.y()), z(local.z());
  const auto inside = [](int first) { return std::clamp(first + 1, 0, side - 3); }; // rounding may leave the brick
  const float* weights = windows_[depth].weights + inside(x.first) + side * (inside(y.first) + side * inside(z.first));
  float sum = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      for (int q = 0; q < 3; ++q)
        sum += weights[q + side * (r + side * c)] * x.value[q] * y.value[r] * z.value[c];
  return sum;
}

Density::Estimate Density::Reader::at(int depth, Index brick, const Eigen::Vector3f& position)
{
  // The kernel, a quadratic B-spline convolved with itself, gathers this on a plane with one sample per face of a cell.
  constexpr float plane_weight = 0.55f;
  constexpr float least_weight = 2.f;        // about twenty samples within the kernel; fewer are no estimate
  constexpr float negligible_weight = 0.02f; // as good as no samples
  const Octree& tree = *density_.tree_;
  float weight = 0, finer_weight = 0;
  int d = depth;
  for (;; --d) {
    if (density_.fields_[d].size() > 0) {
      finer_weight = weight;
      weight = weightAt(d, brick, position);
      if (weight >= least_weight || d == 2)
        break;
    }
    brick = tree.levels[d].parents[brick];
  }
  weight = std::max(weight, negligible_weight);
  const float per_face = weight / plane_weight; // samples per face of a cell of depth d
  Estimate estimate;
  estimate.depth = d + 0.5f * std::log2(per_face);
  estimate.area = std::ldexp(1.f, 2 * (tree.depth - d)) / per_face;
  const float finer_per_face = std::max(finer_weight, negligible_weight) / plane_weight;
  estimate.support = estimate.depth;
  if (d < std::max(2, tree.depth - 1))
    estimate.support = std::min(estimate.depth, d + 1 + 0.5f * std::log2(finer_per_face));
  return estimate;
}

void estimateDensity(const Octree& tree, const Density& density, float samples_per_node, Samples& samples, int threads)
{
  const BrickLevel& finest = tree.levels.back();
  const SampleRanges ranges = sampleRanges(finest, samples.codes, tree.depth, threads);
  const float shift = 0.5f * std::log2(samples_per_node);
  parallelRanges(finest.size(), threads, [&](Index begin, Index end) {
    Density::Reader reader(density);
    for (Index b = begin; b < end; ++b)
      for (const std::uint32_t i : ranges[b]) {
        Sample& s = samples.samples[i];
        const Density::Estimate estimate = reader.at(tree.depth, b, s.position);
        s.depth = estimate.depth - shift;
        s.area *= estimate.area;
      }
  });
}
} // namespace fresco::poisson
