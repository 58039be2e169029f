// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/level_system.h"
#include "poisson/octree/splat.h"
#include "poisson/samples/exact_sum.h"
#include "poisson/solver/base_solver.h"
#include "poisson/solver/expected_values.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
/// Stencil of integral grad B_j . grad B_k for hat functions of a unit grid, by the number of axes on which j and k
/// differ: products of their mass (2/3, 1/6) and stiffness (2, -1) on one axis.
constexpr float laplacian[4] = {8.f / 3.f, 0.f, -1.f / 6.f, -1.f / 12.f};

/// haloStep() of each neighbour.
constexpr std::array<int, 27> steps = [] {
  std::array<int, 27> all{};
  for (int o = 0; o < 27; ++o)
    all[o] = haloStep(o);
  return all;
}();

/// By four bits: the nodes of a line whose bit is set.
using Lanes [[gnu::vector_size(16)]] = int;
constexpr Lanes fixed_lanes[16] = {{0, 0, 0, 0},   {-1, 0, 0, 0},   {0, -1, 0, 0},   {-1, -1, 0, 0},
                                   {0, 0, -1, 0},  {-1, 0, -1, 0},  {0, -1, -1, 0},  {-1, -1, -1, 0},
                                   {0, 0, 0, -1},  {-1, 0, 0, -1},  {0, -1, 0, -1},  {-1, -1, 0, -1},
                                   {0, 0, -1, -1}, {-1, 0, -1, -1}, {0, -1, -1, -1}, {-1, -1, -1, -1}};

/// All bricks of shallow levels; of deeper ones an eighth, whole blocks of siblings by a hash of their place: enough
/// for norms.
bool isSampled(const BrickLevel& level, Index brick)
{
  constexpr int shallow = 8;
  return level.depth <= shallow || ((level.codes[brick] >> 3) * 0x9E3779B97F4A7C15u) >> 61 == 0;
}
} // namespace

/// A brick with what lies around it, in the cache.
struct LevelSystem::Block {
  float x[halo_size] = {};
  MatrixRows rows;
  float inverse[own_nodes]; ///< of the diagonal
  float right[own_nodes];
  std::uint64_t fixed;   ///< see fixedNodes()
  std::uint64_t bounded; ///< see LevelSystem::keepFree()

  void sweep(int sweeps);
  template <int count>
  void relax(const int* lines);
  Norms residual() const;
};

LevelSystem::LevelSystem(const BrickLevel& level, const SampleLevel& samples, Array<float>&& expected, int finest,
                         float point_weight, int threads)
    : level_(level), ranges_(sampleRanges(level, samples.codes, samples.depth, threads)), samples_(samples),
      scale_(std::ldexp(1.f, level.depth - finest)), weights_(screeningWeights(samples, scale_, point_weight, threads)),
      expected_(std::move(expected)), threads_(threads)
{
  for (int k = 0; k < 27; ++k)
    std::fill_n(laplacian_rows_[k], own_nodes, laplacian[axesOf(k)]);
}

void LevelSystem::assemble(Index brick, const Neighbors& neighbors, Block& block) const
{
  std::memcpy(block.rows, laplacian_rows_, sizeof(block.rows));
  const Eigen::Vector3f origin = level_.origin(brick);
  const int finer = 3 * (samples_.depth - level_.depth); // bits of a code
  for (std::uint64_t o = 0; o < 8; ++o) {
    const int n = neighbors[offsetIndex(-(o & 1), -(o >> 1 & 1), -(o >> 2))];
    if (n < 0)
      continue;
    const std::uint64_t last_cells = (o | o << 3) << finer; // of the neighbour, on the axes where it is below
    for (const std::uint32_t i : ranges_[n])
      if ((samples_.codes[i] & last_cells) == last_cells && weights_[i] > 0.f) {
        const HatWeights hat(samples_.samples[i].position * scale_ - origin);
        addScreening(hat, weights_[i], block.rows);
        if (const float expected = expectedOf(expected_, i); expected != 0.f)
          addExpected(hat, weights_[i] * expected, block.right);
      }
  }
  for (int i = 0; i < own_nodes; ++i)
    block.inverse[i] = 1.f / block.rows[offset_self][i];
}

void LevelSystem::load(Index brick, const NodeField& b, const NodeField& x, Block& block) const
{
  const Neighbors neighbors = level_.neighborsOf(brick);
  std::copy_n(b.own(brick), own_nodes, block.right);
  assemble(brick, neighbors, block);
  loadHalo(level_, neighbors, x, block.x);
  block.fixed = fixedNodes(neighbors);
  block.bounded = bounded_.empty() ? 0 : bounded_[brick];
}

/// Relaxes lines of the brick that do not depend on each other, side by side: each sum is a chain of operations.
template <int count>
void LevelSystem::Block::relax(const int* lines)
{
  Line sum[count];
  float* at[count];
  for (int i = 0; i < count; ++i) {
    at[i] = &x[haloIndex(0, lines[i] & 3, lines[i] >> 2)];
    sum[i] = line(&right[lines[i] * brick_cells]);
  }
  for (int k = 0; k < 27; ++k)
    if (k != offset_self)
      for (int i = 0; i < count; ++i)
        sum[i] -= line(&rows[k][lines[i] * brick_cells]) * line(at[i] + steps[k]);
  for (int i = 0; i < count; ++i) {
    const int own = lines[i] * brick_cells;
    const Line value = sum[i] * line(&inverse[own]), bound = Line{} + clear_margin;
    const Line relaxed = (value < bound) & fixed_lanes[bounded >> own & 15] ? bound : value;
    line(at[i]) = fixed_lanes[fixed >> own & 15] ? line(at[i]) : relaxed;
  }
}

/// Gauss-Seidel sweeps over the nodes of the brick, as if line by line in the order of y + 4 z. A line depends on those
/// next to it only, so line (y, z) may be taken at step y + 2 z, and in the next sweep four steps later.
void LevelSystem::Block::sweep(int sweeps)
{
  constexpr int steps_a_sweep = 3 + 2 * 3 + 1, delay = 4;
  for (int step = 0; step < steps_a_sweep + delay * (sweeps - 1); ++step) {
    int lines[4], count = 0;
    for (int s = 0; s < sweeps; ++s)
      for (int z = 0; z < brick_cells; ++z)
        if (const int y = step - delay * s - 2 * z; y >= 0 && y < brick_cells)
          lines[count++] = y + brick_cells * z;
    switch (count) {
    case 1:
      relax<1>(lines);
      break;
    case 2:
      relax<2>(lines);
      break;
    case 3:
      relax<3>(lines);
      break;
    case 4:
      relax<4>(lines);
      break;
    }
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
    for (int color = 0; color < 8; ++color) {
      const std::vector<BrickRun>& runs = level_.colors[color];
      parallelFor(runs.size(), threads_, [&](Index r) {
        const BrickRun run = runs[r];
        for (int brick = run.begin; level_.owns(run.begin) && brick < run.end; ++brick)
          smoothBrick(brick, b, std::min(local_sweeps, iterations - done), x);
      });
      refreshOwnNodes(level_, x, color);
    }
  refreshGhosts(level_, x);
}

void LevelSystem::smoothBrick(Index brick, const NodeField& b, int sweeps, NodeField& x) const
{
  Block block;
  load(brick, b, x, block);
  block.sweep(sweeps);
  float* nodes = x.own(brick);
  for (int y_z = 0; y_z < brick_cells * brick_cells; ++y_z)
    line(&nodes[y_z * brick_cells]) = line(&block.x[haloIndex(0, y_z & 3, y_z >> 2)]);
}

/// @param position in cells of the level
bool LevelSystem::isNearSample(const Neighbors& neighbors, const Eigen::Vector3f& position) const
{
  constexpr float reach = 1.5f; // cells; nearer, beams that passed beside what was measured would thin it
  for (const int n : neighbors)
    if (n >= 0)
      for (const std::uint32_t i : ranges_[n])
        if ((samples_.samples[i].position * scale_ - position).squaredNorm() < reach * reach)
          return true;
  return false;
}

void LevelSystem::findBounded(const FreePlaces& places, const NodeField& x)
{
  bounded_.assign(level_.size(), 0);
  parallelFor(level_.size(), threads_, [&](Index b) {
    const Neighbors neighbors = level_.neighborsOf(b);
    const std::uint64_t fixed = fixedNodes(neighbors);
    const float* values = x.own(b);
    for (int i = 0; i < own_nodes; ++i) {
      if (values[i] >= clear_margin || fixed >> i & 1)
        continue;
      const Eigen::Vector3f position = level_.origin(b) + Eigen::Vector3f(i & 3, i >> 2 & 3, i >> 4);
      if (places.isFree(position / scale_, 1 / scale_) && !isNearSample(neighbors, position))
        bounded_[b] |= std::uint64_t(1) << i;
    }
  });
}

void LevelSystem::keepFree(const FreePlaces& places, const NodeField& b, int iterations, NodeField& x)
{
  if (!places.map)
    return;
  findBounded(places, x);
  if (std::any_of(bounded_.begin(), bounded_.end(), [](std::uint64_t nodes) { return nodes != 0; }))
    smooth(b, iterations, x);
}

void LevelSystem::addMultiplierUpdate(const NodeField& x, NodeField& right) const
{
  splatBricks(level_, ranges_, right, threads_, [&](SplatBlock<1>& block, int b) {
    const Eigen::Vector3f origin = level_.origin(b);
    float nodes[nodes_per_brick];
    x.load(level_, b, nodes);
    for (const std::uint32_t i : ranges_[b]) {
      const CoarseSample& s = samples_.samples[i];
      const float isolated = std::clamp(level_.depth + 1.f - s.depth, 0.f, 1.f);
      if (isolated * weights_[i] <= 0.f)
        continue;
      const HatWeights hat = HatWeights::inBrick(s.position * scale_ - origin);
      const float multiplier = isolated * weights_[i] * (expectedOf(expected_, i) - hat.interpolate(nodes));
      for (int k = 0; k < 8; ++k)
        block.at(hat.x + (k & 1), hat.y + (k >> 1 & 1), hat.z + (k >> 2)) += multiplier * hat.value[k];
    }
  });
  refreshGhosts(level_, right);
}

LevelSystem::Norms LevelSystem::residual(const NodeField& b, const NodeField& x) const
{
  const BrickRun own = level_.own();
  const Eigen::Array2d sums = exactSums(level_.exchange(), own.end - own.begin, threads_, [&](Index i) {
    if (!isSampled(level_, own.begin + i))
      return Eigen::Array2d(0, 0);
    Block block;
    load(own.begin + i, b, x, block);
    const Norms norms = block.residual();
    return Eigen::Array2d(norms.residual, norms.right);
  });
  return {sums[0], sums[1]};
}
} // namespace fresco::poisson
