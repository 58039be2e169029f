// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/solver.h"
#include "poisson/noise.h"
#include "poisson/octree/halo.h"
#include "poisson/octree/splat.h"
#include <algorithm>
#include <cstring>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
/// Sweeps over a brick while it is in the cache.
constexpr int local_sweeps = 2;
/// Area, in faces of a cell, beyond which an isolated sample pulls no harder: three depths below what the data sustain.
constexpr float most_faces = 64.f;

/// Stencil of integral grad B_i . grad B_j for hat functions of a unit grid, by
/// the number of axes on which i and j differ.
constexpr float laplacian[4] = {8.f / 3.f, 0.f, -1.f / 6.f, -1.f / 12.f};
} // namespace

/// A brick with what lies around it, in the cache.
struct LevelSystem::Block {
  float x[halo_size] = {};
  float rows[27][own_nodes]; ///< matrix entries by offsetIndex()
  float inverse[own_nodes];  ///< of the diagonal
  float right[own_nodes];
  std::uint64_t fixed; ///< see fixedNodes()

  void sweep();
  Norms residual() const;
};

LevelSystem::LevelSystem(const BrickLevel& level, const SampleLevel& samples, int finest, float point_weight,
                         int threads)
    : level_(level), begin_(sampleRanges(level, samples.codes, samples.depth, threads)),
      samples_(samples.samples.size()), threads_(threads)
{
  const float scale = std::ldexp(1.f, level.depth - finest);
  parallelFor(samples_.size(), threads, [&](Index i) {
    const CoarseSample& s = samples.samples[i];
    const float isolated = std::clamp(static_cast<float>(level.depth) + 1.f - s.depth, 0.f, 1.f);
    const float faces = std::min(s.area * scale * scale, most_faces);
    const float weight = point_weight * screeningWeight(s.noise * scale) * faces;
    samples_[i] = {s.position * scale, weight, isolated};
  });
  for (int k = 0; k < 27; ++k) {
    std::fill_n(laplacian_rows_[k], own_nodes, laplacian[axesOf(k)]);
  }
}

void LevelSystem::addSample(const HatWeights& hat, float weight, Block& block)
{
  for (int i = 0; i < 8; ++i) {
    const int ix = i & 1, iy = i >> 1 & 1, iz = i >> 2;
    const int x = hat.x + ix, y = hat.y + iy, z = hat.z + iz;
    if (((x | y | z) & ~3) != 0)
      continue;
    float* row = &block.rows[offsetIndex(-ix, -iy, -iz)][ownIndex(x, y, z)];
    const float wi = weight * hat.value[i];
    for (int j = 0; j < 8; ++j)
      row[offsetIndex((j & 1) - 1, (j >> 1 & 1) - 1, (j >> 2) - 1) * own_nodes] += wi * hat.value[j];
  }
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
    for (std::uint32_t i = begin_[n]; i < begin_[static_cast<std::size_t>(n) + 1]; ++i) {
      const Eigen::Vector3f position = samples_[i].position - origin;
      if (position.x() >= -1.f && position.y() >= -1.f && position.z() >= -1.f && samples_[i].weight > 0.f)
        addSample(HatWeights(position), samples_[i].weight, block);
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
        norms.residual += static_cast<double>(sum[i]) * static_cast<double>(sum[i]);
        norms.right += static_cast<double>(right[own + i]) * static_cast<double>(right[own + i]);
      }
  }
  return norms;
}

void LevelSystem::smooth(const NodeField& b, int iterations, NodeField& x) const
{
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

void LevelSystem::addPull(const NodeField& x, NodeField& pull) const
{
  splatBricks(level_, begin_, pull, threads_, [&](SplatBlock<1>& block, int b) {
    const Eigen::Vector3f origin = level_.origin(b);
    for (std::uint32_t i = begin_[b]; i < begin_[static_cast<std::size_t>(b) + 1]; ++i) {
      const Constraint& s = samples_[i];
      if (s.isolated * s.weight <= 0.f)
        continue;
      const HatWeights hat = HatWeights::inBrick(s.position - origin);
      const float force = -s.isolated * s.weight * hat.interpolate(x.brick(b));
      for (int k = 0; k < 8; ++k)
        block.at(hat.x + (k & 1), hat.y + (k >> 1 & 1), hat.z + (k >> 2)) += force * hat.value[k];
    }
  });
  syncFaces(level_, pull, threads_);
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
