// SPDX-License-Identifier: BSD-3-Clause
#include "volumetric_solver.h"
#include "volumetric_noise.h"
#include "volumetric_splat.h"
#include <algorithm>
#include <cstring>
#include <fresco/common/parallel.h>
namespace fresco::volumetric {
namespace {
constexpr int halo_row = 8,
              halo_slice = 6 * halo_row; ///< nodes -1..4 of a brick, rows padded
constexpr int own_nodes = brick_cells * brick_cells * brick_cells;
/// Sweeps over a brick while it is in the cache.
constexpr int local_sweeps = 2;
/// Area, in faces of a cell, beyond which an isolated sample pulls no harder: three depths below what the data sustain.
constexpr float most_faces = 64.f;

/// Stencil of integral grad B_i . grad B_j for hat functions of a unit grid, by
/// the number of axes on which i and j differ.
constexpr float laplacian[4] = {8.f / 3.f, 0.f, -1.f / 6.f, -1.f / 12.f};

/// Four nodes in a row along x, at any address.
using Line [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = float;
inline Line& line(float* p) { return *reinterpret_cast<Line*>(p); }
inline const Line& line(const float* p) { return *reinterpret_cast<const Line*>(p); }

constexpr int haloIndex(int x, int y, int z) { return (x + 1) + halo_row * (y + 1) + halo_slice * (z + 1); }
constexpr int haloStep(int k) { return (k % 3 - 1) + halo_row * (k / 3 % 3 - 1) + halo_slice * (k / 9 - 1); }
constexpr int ownIndex(int x, int y, int z) { return x + brick_cells * (y + brick_cells * z); }
} // namespace

/// A brick with what lies around it, in the cache.
struct LevelSystem::Block {
  float x[6 * halo_slice] = {};
  float rows[27][own_nodes]; ///< matrix entries by offsetIndex()
  float inverse[own_nodes];  ///< of the diagonal
  float right[own_nodes];
  bool unknown[own_nodes];

  void sweep();
  Norms residual() const;
};

LevelSystem::LevelSystem(const BrickLevel& level, const SampleLevel& samples, int finest, float point_weight,
                         int threads)
    : level_(level), begin_(sampleRanges(level, samples.codes, samples.depth, threads)),
      samples_(samples.samples.size()), threads_(threads)
{
  const float scale = std::ldexp(1.f, level.depth - finest);
  parallelFor(static_cast<Index>(samples_.size()), threads, [&](Index i) {
    const CoarseSample& s = samples.samples[static_cast<std::size_t>(i)];
    const float isolated = std::clamp(static_cast<float>(level.depth) + 1.f - s.depth, 0.f, 1.f);
    const float faces = std::min(s.area * scale * scale, most_faces);
    const float weight = point_weight * screeningWeight(s.noise * scale) * faces;
    samples_[static_cast<std::size_t>(i)] = {s.position * scale, weight, isolated};
  });
  for (int k = 0; k < 27; ++k) {
    const int axes = (k % 3 != 1) + (k / 3 % 3 != 1) + (k / 9 != 1);
    std::fill_n(laplacian_rows_[k], own_nodes, laplacian[axes]);
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
  const auto& neighbors = level_.neighbors[static_cast<std::size_t>(brick)];
  const Eigen::Vector3f origin = level_.origin(brick);
  for (int o = 0; o < 8; ++o) {
    const int n = neighbors[static_cast<std::size_t>(offsetIndex(-(o & 1), -(o >> 1 & 1), -(o >> 2)))];
    if (n < 0)
      continue;
    for (std::uint32_t i = begin_[static_cast<std::size_t>(n)]; i < begin_[static_cast<std::size_t>(n) + 1]; ++i) {
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
  const auto& neighbors = level_.neighbors[static_cast<std::size_t>(brick)];
  for (int o = 0; o < 27; ++o) {
    const int d[3] = {o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1};
    int h[3] = {d[0], d[1], d[2]}; // offset of the brick that holds the nodes
    int holder = neighbors[static_cast<std::size_t>(o)];
    for (int m = 1; m < 8 && holder < 0; ++m) { // else one that has them on its upper faces
      for (int a = 0; a < 3; ++a)
        h[a] = m >> a & 1 ? std::min(d[a], 0) : d[a];
      holder = neighbors[static_cast<std::size_t>(offsetIndex(h[0], h[1], h[2]))];
    }
    copyPart(holder < 0 ? nullptr : x.brick(holder), d, h, block);
  }
}

/// Nodes of the brick at offset `d`, as far as they belong to the halo, from those of the brick at offset `h`; else
/// zeros.
void LevelSystem::copyPart(const float* nodes, const int d[3], const int h[3], Block& block)
{
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    first[a] = d[a] < 0 ? -1 : d[a] > 0 ? brick_cells : 0;
    last[a] = d[a] == 0 ? brick_cells - 1 : first[a];
  }
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y) {
      float* to = &block.x[haloIndex(first[0], y, z)];
      const float* from = nodes ? nodes + nodeIndex(first[0] - 4 * h[0], y - 4 * h[1], z - 4 * h[2]) : nullptr;
      if (d[0] == 0)
        line(to) = from ? line(from) : Line{};
      else
        *to = from ? *from : 0.f;
    }
}

void LevelSystem::excludeFixed(Index brick, Block& block) const
{
  const auto& neighbors = level_.neighbors[static_cast<std::size_t>(brick)];
  unsigned missing = 0; // bit o: the brick below in the axes of o's bits
  for (int o = 1; o < 8; ++o)
    if (neighbors[static_cast<std::size_t>(offsetIndex(-(o & 1), -(o >> 1 & 1), -(o >> 2)))] < 0)
      missing |= 1u << o;
  for (int i = 0; i < own_nodes; ++i) {
    const int on_face = ((i & 3) == 0) | ((i >> 2 & 3) == 0) << 1 | ((i >> 4) == 0) << 2;
    bool fixed = false;
    for (int o = 1; o < 8; ++o)
      fixed |= (o & ~on_face) == 0 && (missing >> o & 1);
    block.unknown[i] = !fixed;
    if (!fixed)
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
      if (unknown[own + i]) {
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
      parallelFor(static_cast<Index>(runs.size()), threads_, [&](Index r) {
        const BrickRun run = runs[static_cast<std::size_t>(r)];
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
    for (std::uint32_t i = begin_[static_cast<std::size_t>(b)]; i < begin_[static_cast<std::size_t>(b) + 1]; ++i) {
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
} // namespace fresco::volumetric
