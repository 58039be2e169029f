// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/transfer.h"
#include "poisson/octree/bytes.h"
#include <algorithm>
#include <cstring>
namespace fresco::poisson {
namespace {
/// Index of the parent's node at the lower corner of an octant.
int octantCorner(int octant) { return nodeIndex((octant & 1) * 2, (octant >> 1 & 1) * 2, (octant >> 2) * 2); }

constexpr int upper_stride = 64; // upper nodes in whole cache lines

/// Makes the sums of other ranks' bricks theirs. @param upper sums on the upper faces of each brick
void shareSums(const BrickLevel& fine_level, const BrickLevel& level, NodeField& field, Array<float>& upper)
{
  using Upper = std::array<float, upper_stride>;
  level.ghosts.refresh(reinterpret_cast<Upper*>(upper.data()));
  if (!fine_level.ghosts.isDivided() || level.ghosts.isDivided())
    return;
  struct Sums {
    std::array<float, nodes_per_brick> held;
    Upper upper;
  };
  std::vector<Sums> own;
  for (int b = level.ghosts.own.begin; b < level.ghosts.own.end; ++b) {
    own.emplace_back();
    field.loadHeld(level, b, own.back().held.data());
    std::copy_n(&upper[b * upper_stride], upper_stride, own.back().upper.begin());
  }
  const Array<Sums> all = gatherAll(*fine_level.ghosts.exchange, own.data(), own.size());
  for (Index b = 0; b < level.size(); ++b) {
    field.store(level, b, all[b].held.data());
    std::copy_n(all[b].upper.begin(), upper_stride, &upper[b * upper_stride]);
  }
}

constexpr int step_y = brick_nodes, step_z = brick_nodes * brick_nodes;
} // namespace

void interpolateToChild(const float* parent, int octant, float* child)
{
  const float* base = parent + octantCorner(octant);
  for (int z = 0; z < brick_nodes; z += 2)
    for (int y = 0; y < brick_nodes; y += 2) {
      const float* from = base + y / 2 * step_y + z / 2 * step_z;
      float* to = child + nodeIndex(0, y, z);
      to[0] = from[0];
      to[1] = 0.5f * (from[0] + from[1]);
      to[2] = from[1];
      to[3] = 0.5f * (from[1] + from[2]);
      to[4] = from[2];
    }
  for (int z = 0; z < brick_nodes; z += 2)
    for (int y = 1; y < brick_nodes; y += 2)
      for (int x = 0; x < brick_nodes; ++x) {
        float* to = child + nodeIndex(x, y, z);
        *to = 0.5f * (to[-step_y] + to[step_y]);
      }
  for (int z = 1; z < brick_nodes; z += 2)
    for (int i = 0; i < step_z; ++i) {
      float* to = child + z * step_z + i;
      *to = 0.5f * (to[-step_z] + to[step_z]);
    }
}

void restrictToParent(const float* child, int octant, float factor, float* parent)
{
  float block[nodes_per_brick];
  std::memcpy(block, child, sizeof(block));
  for (int z = 1; z < brick_nodes; z += 2)
    for (int i = 0; i < step_z; ++i) {
      const float half = 0.5f * block[z * step_z + i];
      block[(z - 1) * step_z + i] += half;
      block[(z + 1) * step_z + i] += half;
    }
  for (int z = 0; z < brick_nodes; z += 2)
    for (int y = 1; y < brick_nodes; y += 2)
      for (int x = 0; x < brick_nodes; ++x) {
        const float half = 0.5f * block[nodeIndex(x, y, z)];
        block[nodeIndex(x, y - 1, z)] += half;
        block[nodeIndex(x, y + 1, z)] += half;
      }
  float* base = parent + octantCorner(octant);
  for (int z = 0; z < brick_nodes; z += 2)
    for (int y = 0; y < brick_nodes; y += 2) {
      const float* from = block + nodeIndex(0, y, z);
      float* to = base + y / 2 * step_y + z / 2 * step_z;
      to[0] += factor * (from[0] + 0.5f * from[1]);
      to[1] += factor * (from[2] + 0.5f * (from[1] + from[3]));
      to[2] += factor * (from[4] + 0.5f * from[3]);
    }
}

void restrictLevel(const BrickLevel& fine_level, const NodeField& fine, const BrickLevel& coarse_level, float factor,
                   NodeField& coarse, int threads)
{
  Array<float> upper(coarse_level.codes.size() * upper_stride);
  parallelFor(coarse_level.size(), threads, [&](Index p) {
    float parent[nodes_per_brick], held[nodes_per_brick];
    coarse.loadHeld(coarse_level, p, parent);
    for (int octant = 0; octant < 8; ++octant)
      if (const int c = coarse_level.child(p, octant); c >= 0) {
        fine.loadHeld(fine_level, c, held);
        restrictToParent(held, octant, factor, parent);
      }
    coarse.store(coarse_level, p, parent);
    copyUpperNodes(parent, &upper[p * upper_stride]);
  });
  shareSums(fine_level, coarse_level, coarse, upper);
  parallelFor(coarse_level.size(), threads, [&](Index p) {
    float* own = coarse.own(p);
    const Neighbors neighbors = coarse_level.neighborsOf(p);
    for (int axes = 1; axes < 8; ++axes) { // what the neighbours below have on their upper faces
      const int dx = axes & 1, dy = axes >> 1 & 1, dz = axes >> 2;
      const int n = neighbors[offsetIndex(-dx, -dy, -dz)];
      if (n < 0)
        continue;
      const float* part = &upper[n * upper_stride + upperPart(axes)];
      for (int z = 0; z < (dz ? 1 : brick_cells); ++z)
        for (int y = 0; y < (dy ? 1 : brick_cells); ++y)
          for (int x = 0; x < (dx ? 1 : brick_cells); ++x)
            own[ownIndex(x, y, z)] += part[rimIndex(axes, x, y, z)];
    }
  });
  refreshGhosts(coarse_level, coarse);
}
} // namespace fresco::poisson
