// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/level_system.h"
#include "poisson/octree/splat.h"
#include <algorithm>
#include <cstring>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
/// Stencil of integral grad B_j . grad B_k for hat functions of a unit grid, by the number of axes on which j and k
/// differ: products of their mass (2/3, 1/6) and stiffness (2, -1) on one axis.
constexpr float laplacian[4] = {8.f / 3.f, 0.f, -1.f / 6.f, -1.f / 12.f};
} // namespace

/// A brick with what lies around it, in the cache.
struct LevelSystem::Block {
  float x[halo_size] = {};
  MatrixRows rows;
  float inverse[own_nodes]; ///< of the diagonal
  float right[own_nodes];
  std::uint64_t fixed; ///< see fixedNodes()

  void sweep();
  Norms residual() const;
};

LevelSystem::LevelSystem(const BrickLevel& level, const SampleLevel& samples, int finest, float point_weight,
                         int threads)
    : level_(level), begin_(sampleRanges(level, samples.codes, samples.depth, threads)),
      samples_(screenedSamples(level, samples, finest, point_weight, threads)), threads_(threads)
{
  for (int k = 0; k < 27; ++k)
    std::fill_n(laplacian_rows_[k], own_nodes, laplacian[axesOf(k)]);
}

void LevelSystem::assemble(Index brick, Block& block) const
{
  std::memcpy(block.rows, laplacian_rows_, sizeof(block.rows));
  const auto& neighbors = level_.neighbors[brick];
  const Eigen::Vector3f origin = level_.origin(brick);
  for (int o = 0; o < 8; ++o) {
    const int n = neighbors[offsetIndex(-(o & 1), -(o >> 1 & 1), -(o >> 2))];
    if (n < 0)
      continue;
    for (std::uint32_t i = begin_[n]; i < begin_[n + 1]; ++i) {
      const Eigen::Vector3f position = samples_[i].position - origin;
      if (position.x() >= -1.f && position.y() >= -1.f && position.z() >= -1.f && samples_[i].weight > 0.f)
        addScreening(HatWeights(position), samples_[i].weight, block.rows);
    }
  }
  for (int i = 0; i < own_nodes; ++i)
    block.inverse[i] = 1.f / block.rows[offset_self][i];
}

void LevelSystem::load(Index brick, const NodeField& b, const NodeField& x, Block& block) const
{
  const float* right = b.brick(brick);
  for (int y_z = 0; y_z < brick_cells * brick_cells; ++y_z)
    line(&block.right[y_z * brick_cells]) = line(&right[nodeIndex(0, y_z & 3, y_z >> 2)]);
  loadHalo(level_, brick, x, block.x);
}

void LevelSystem::excludeFixed(Index brick, Block& block) const
{
  block.fixed = fixedNodes(level_, brick);
  for (int i = 0; i < own_nodes && block.fixed >> i != 0; ++i) {
    if (!(block.fixed >> i & 1))
      continue;
    for (auto& row : block.rows)
      row[i] = 0.f;
    block.inverse[i] = 1.f;
    block.right[i] = block.x[haloIndex(i & 3, i >> 2 & 3, i >> 4)];
  }
}

void LevelSystem::Block::sweep()
{
  for (int y_z = 0; y_z < brick_cells * brick_cells; ++y_z) {
    float* at = &x[haloIndex(0, y_z & 3, y_z >> 2)];
    const int own = y_z * brick_cells;
    Line sum = line(&right[own]);
    for (int k = 0; k < 27; ++k)
      if (k != offset_self)
        sum -= line(&rows[k][own]) * line(at + haloStep(k));
    line(at) = sum * line(&inverse[own]);
  }
}

LevelSystem::Norms LevelSystem::Block::residual() const
{
  Norms norms;
  for (int y_z = 0; y_z < brick_cells * brick_cells; ++y_z) {
    const float* at = &x[haloIndex(0, y_z & 3, y_z >> 2)];
    const int own = y_z * brick_cells;
    Line sum = line(&right[own]);
    for (int k = 0; k < 27; ++k)
      sum -= line(&rows[k][own]) * line(at + haloStep(k));
    for (int i = 0; i < brick_cells; ++i)
      if (!(fixed >> (own + i) & 1)) {
        const double r = sum[i], b = right[own + i];
        norms.residual += r * r;
        norms.right += b * b;
      }
  }
  return norms;
}

void LevelSystem::smooth(const NodeField& b, int iterations, NodeField& x) const
{
  constexpr int local_sweeps = 2; // the second one over a brick that is in the cache already costs little
  for (int done = 0; done < iterations; done += local_sweeps)
    for (const std::vector<BrickRun>& runs : level_.colors)
      parallelFor(runs.size(), threads_, [&](Index r) {
        const BrickRun run = runs[r];
        for (int brick = run.begin; brick < run.end; ++brick)
          smoothBrick(brick, b, std::min(local_sweeps, iterations - done), x);
      });
  syncFaces(level_, x, threads_);
}

void LevelSystem::smoothBrick(Index brick, const NodeField& b, int sweeps, NodeField& x) const
{
  Block block;
  assemble(brick, block);
  load(brick, b, x, block);
  excludeFixed(brick, block);
  for (int s = 0; s < sweeps; ++s)
    block.sweep();
  float* nodes = x.brick(brick);
  for (int y_z = 0; y_z < brick_cells * brick_cells; ++y_z)
    line(&nodes[nodeIndex(0, y_z & 3, y_z >> 2)]) = line(&block.x[haloIndex(0, y_z & 3, y_z >> 2)]);
}

void LevelSystem::addMultiplierUpdate(const NodeField& x, NodeField& right) const
{
  splatBricks(level_, begin_, right, threads_, [&](SplatBlock<1>& block, int b) {
    const Eigen::Vector3f origin = level_.origin(b);
    for (std::uint32_t i = begin_[b]; i < begin_[b + 1]; ++i) {
      const ScreenedSample& s = samples_[i];
      if (s.isolated * s.weight <= 0.f)
        continue;
      const HatWeights hat = HatWeights::inBrick(s.position - origin);
      const float multiplier = -s.isolated * s.weight * hat.interpolate(x.brick(b));
      for (int k = 0; k < 8; ++k)
        block.at(hat.x + (k & 1), hat.y + (k >> 1 & 1), hat.z + (k >> 2)) += multiplier * hat.value[k];
    }
  });
  syncFaces(level_, right, threads_);
}

LevelSystem::Norms LevelSystem::residual(const NodeField& b, const NodeField& x) const
{
  const auto add = [](Norms a, const Norms& part) { return Norms{a.residual + part.residual, a.right + part.right}; };
  return parallelReduce(
      level_.size(), threads_, Norms{},
      [&](Index begin, Index end) {
        Norms sum;
        for (Index brick = begin; brick < end; ++brick) {
          Block block;
          assemble(brick, block);
          load(brick, b, x, block);
          excludeFixed(brick, block);
          sum = add(sum, block.residual());
        }
        return sum;
      },
      add);
}
} // namespace fresco::poisson
