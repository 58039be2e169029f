// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/attributes.h"
#include "poisson/octree/splat.h"
#include "poisson/solver/hat_function.h"
#include "poisson/solver/transfer.h"
#include <algorithm>
namespace fresco::poisson {
namespace {
using Channels = Eigen::Matrix<float, 5, 1>; ///< weight, weight times attributes
constexpr int channel_count = Channels::RowsAtCompileTime;
using Fields = std::array<NodeField, channel_count>;

Channels channelsOf(const AttributedSamples& samples, std::uint32_t i)
{
  Channels c;
  c << 1.f, samples.attributes[i];
  return c * samples.level.samples[i].area;
}

class Transfer {
public:
  Transfer(const Octree& tree, const AttributedSamples& samples, int threads)
      : tree_(tree), samples_(samples),
        ranges_(sampleRanges(tree.levels.back(), samples.level.codes, tree.depth, threads)), fields_(tree.levels.size())
  {
    for (int d = tree.depth - 1; d >= 2; --d)
      makeFields(d, threads);
  }

  void fillRange(const VertexRange& range, const Points& vertices, Eigen::Matrix4Xf& result) const
  {
    constexpr float least_weight = 1e-4f; // a sample in a far corner; less is rounding
    std::vector<Channels> nodes;
    if (range.depth == tree_.depth)
      nodes = finestNodes(range.brick);
    for (Index v = range.first; v < range.first + range.count; ++v) {
      Channels sum = Channels::Zero();
      if (!nodes.empty())
        sum = interpolate(nodes, toBrick(vertices.col(v), range.depth, range.brick));
      Index b = range.brick;
      for (int d = range.depth; sum[0] < least_weight && d >= 2; b = parent(d--, b))
        if (d < tree_.depth)
          sum = interpolate(d, b, vertices.col(v));
      result.col(v) = sum.tail<4>() / std::max(sum[0], 1e-30f);
    }
  }

private:
  Index parent(int d, Index b) const { return tree_.levels[d].parents[b]; }

  Eigen::Vector3f toBrick(const Eigen::Vector3f& position, int d, Index b) const
  {
    return position * std::ldexp(1.f, d - tree_.depth) - tree_.levels[d].origin(b);
  }

  void makeFields(int d, int threads)
  {
    const BrickLevel& level = tree_.levels[d];
    Fields& fields = fields_[d];
    const SampleRanges ranges = sampleRanges(level, samples_.level.codes, tree_.depth, threads);
    for (int c = 0; c < channel_count; ++c) {
      fields[c] = NodeField(level, threads);
      if (d < tree_.depth - 1) {
        restrictLevel(tree_.levels[d + 1], fields_[d + 1][c], level, 1.f, fields[c], threads);
        continue;
      }
      splatBricks(level, ranges, fields[c], threads, [&](SplatBlock<1>& block, int b) {
        for (const std::uint32_t i : ranges[b]) {
          const HatWeights w(toBrick(samples_.level.samples[i].position, d, b));
          const float value = channelsOf(samples_, i)[c];
          for (int k = 0; k < 8; ++k)
            block.at(w.x + (k & 1), w.y + (k >> 1 & 1), w.z + (k >> 2)) += value * w.value[k];
        }
      });
      refreshGhosts(level, fields[c]);
    }
  }

  std::vector<Channels> finestNodes(Index brick) const
  {
    std::vector<Channels> nodes(nodes_per_brick, Channels::Zero());
    const BrickLevel& level = tree_.levels.back();
    for (const int n : level.neighborsOf(brick)) {
      if (n < 0)
        continue;
      for (const std::uint32_t i : ranges_[n]) {
        const Eigen::Vector3f p = toBrick(samples_.level.samples[i].position, tree_.depth, brick);
        if (p.minCoeff() <= -1.f || p.maxCoeff() >= brick_nodes)
          continue;
        const HatWeights w(p);
        for (int k = 0; k < 8; ++k) {
          const int x = w.x + (k & 1), y = w.y + (k >> 1 & 1), z = w.z + (k >> 2);
          if (std::min({x, y, z}) >= 0 && std::max({x, y, z}) < brick_nodes)
            nodes[nodeIndex(x, y, z)] += w.value[k] * channelsOf(samples_, i);
        }
      }
    }
    return nodes;
  }

  static Channels interpolate(const std::vector<Channels>& nodes, const Eigen::Vector3f& position)
  {
    const HatWeights w = HatWeights::inBrick(position);
    Channels sum = Channels::Zero();
    for (int k = 0; k < 8; ++k)
      sum += w.value[k] * nodes[w.nodeOf(k)];
    return sum;
  }

  Channels interpolate(int d, Index b, const Eigen::Vector3f& position) const
  {
    const HatWeights w = HatWeights::inBrick(toBrick(position, d, b));
    Channels sum;
    for (int c = 0; c < channel_count; ++c)
      sum[c] = w.interpolateWith([&](int x, int y, int z) { return fields_[d][c].value(tree_.levels[d], b, x, y, z); });
    return sum;
  }

  const Octree& tree_;
  const AttributedSamples& samples_;
  SampleRanges ranges_;
  std::vector<Fields> fields_; ///< by depth, coarser than the finest
};
} // namespace

Eigen::Matrix4Xf vertexAttributes(const Octree& tree, const AttributedSamples& samples, const IsoSurface& surface,
                                  int threads)
{
  Eigen::Matrix4Xf result(4, surface.vertices.cols());
  const Transfer transfer(tree, samples, threads);
  parallelFor(surface.ranges.size(), threads,
              [&](Index r) { transfer.fillRange(surface.ranges[r], surface.vertices, result); });
  return result;
}
} // namespace fresco::poisson
