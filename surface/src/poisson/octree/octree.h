// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/bit_count.h"
#include "poisson/octree/ghosts.h"
#include "poisson/octree/partition.h"
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fresco/core/array.h>
#include <fresco/core/types.h>
#include <vector>
namespace fresco::poisson {
/// Cells a side of a brick: a row of four is one vector instruction, and 4^3 cells are the bits of one word.
constexpr int brick_cells = 4;
/// Nodes a side, both faces counted; nodes of a brick.
constexpr int brick_nodes = brick_cells + 1, nodes_per_brick = brick_nodes * brick_nodes * brick_nodes;
/// Nodes of a brick that are not on its upper faces.
constexpr int own_nodes = brick_cells * brick_cells * brick_cells;

/// Place of node (x, y, z), each 0..4, among the nodes of its brick.
constexpr int nodeIndex(int x, int y, int z) { return x + brick_nodes * (y + brick_nodes * z); }
/// Place of node (x, y, z), each 0..3, among those that are not on its upper faces.
constexpr int ownIndex(int x, int y, int z) { return x + brick_cells * (y + brick_cells * z); }

/// Place of the neighbour in direction (dx, dy, dz), each -1..1.
constexpr int offsetIndex(int dx, int dy, int dz) { return (dx + 1) + 3 * (dy + 1) + 9 * (dz + 1); }
constexpr int offset_self = offsetIndex(0, 0, 0);

/// Octant (bits x, y, z) of the brick that holds cell (x, y, z), each 0..3.
constexpr int octantOf(int x, int y, int z) { return (x >> 1) | (y >> 1) << 1 | (z >> 1) << 2; }

/// Indices of the bricks around one, and its own, by offsetIndex(); -1 where there is none.
using Neighbors = std::array<int, 27>;

/// For where there are no others.
Exchange& onlyRank();

/// Nodes on the upper faces of a brick where no neighbour has them as its own.
struct Rim {
  std::uint64_t first : 56; ///< of them among those of all bricks
  std::uint64_t parts : 8;  ///< bit upperAxes()
};

/// The bricks of one octree depth, sorted by Morton code. A brick covers 4^3 cells of side 1 / 2^depth.
struct BrickLevel {
  int depth = 0;
  std::vector<std::uint64_t> codes;    ///< Morton code of the brick's coordinates
  Array<Neighbors> neighbors;          ///< empty at the finest level, which has the most: see neighborsOf()
  const BrickLevel* coarser = nullptr; ///< in the same octree
  Array<int> parents;                  ///< index into the coarser level; -1 at the coarsest
  Array<int> first_children;           ///< index into the finer level; the others follow it, by octant
  Array<std::uint8_t> child_octants;   ///< bits; where there is no child, the cells are leaves
  Array<Rim> rims;
  Index rim_nodes = 0; ///< of all bricks
  /// Blocks of 4^3 bricks, by the octant that a block is in the block of 8^3 around it. Those of one colour never
  /// touch.
  std::array<std::vector<BrickRun>, 8> colors;
  Ghosts ghosts;
  /// With several ranks, of the deepest shared depth: bits by octant, children that are on other ranks only.
  std::vector<std::uint8_t> remote_children;

  Index size() const { return codes.size(); }
  /// Octant of its parent (bits x, y, z) that brick `b` covers.
  int octant(Index b) const { return codes[b] & 7; }
  /// Index into the finer level, -1 if the octant's cells are leaves.
  int child(Index b, int octant) const
  {
    const unsigned octants = child_octants[b];
    return octants >> octant & 1 ? first_children[b] + bitCount(octants & ((1u << octant) - 1)) : -1;
  }
  Neighbors neighborsOf(Index b) const { return neighbors.empty() ? neighborsByParent(b) : neighbors[b]; }
  int neighbor(Index b, int offset) const
  {
    return neighbors.empty() ? neighborByParent(b, offset) : neighbors[b][offset];
  }
  /// The same through the parents.
  Neighbors neighborsByParent(Index b) const;
  int neighborByParent(Index b, int offset) const;
  /// Whether the cells of an octant are leaves.
  bool isLeaf(Index b, int octant) const { return ((child_octants[b] | remoteChildren(b)) >> octant & 1) == 0; }
  unsigned remoteChildren(Index b) const { return remote_children.empty() ? 0 : remote_children[b]; }
  /// Bricks that are no ghosts.
  BrickRun own() const { return ghosts.isDivided() ? ghosts.own : BrickRun{0, static_cast<int>(size())}; }
  Exchange& exchange() const { return ghosts.isDivided() ? *ghosts.exchange : onlyRank(); }
  bool owns(Index b) const { return !ghosts.isDivided() || (b >= ghosts.own.begin && b < ghosts.own.end); }
  /// Coordinates of the lower node of brick `b`, in cells of this depth.
  std::array<int, 3> corner(Index b) const;
  Eigen::Vector3f origin(Index b) const;
};

/// levels[d] for d = 2..depth (0 and 1 are empty).
struct Octree {
  int depth = 0, full_depth = 0;
  std::vector<BrickLevel> levels;
  const Partition* partition = nullptr; ///< nullptr: the only rank

  Octree() = default;
  Octree(Octree&&) = default; // the levels, which point to each other, stay where they are
  Octree& operator=(Octree&&) = default;

  Exchange& exchange() const { return partition ? partition->exchange() : onlyRank(); }
  /// Whether the bricks of a depth are divided among ranks.
  bool isDivided(int d) const { return partition && d > partition->sharedDepth(); }
};

/// @param cell_codes sorted Morton codes of the finest cells that hold samples: of this rank
/// @param full_depth all bricks exist down to this depth, 2..depth
/// @param partition  outlives the octree
Octree buildOctree(const Array<std::uint64_t>& cell_codes, int depth, int full_depth, int threads,
                   const Partition* partition = nullptr);

/// @param codes by depth, from 2 on, sorted; the parent of each brick must be there
Octree linkBricks(std::vector<std::vector<std::uint64_t>> codes, int full_depth, int threads);

/// Bricks per depth that buildOctree() would make.
std::vector<Index> countBricks(const Array<std::uint64_t>& cell_codes, int depth, int full_depth, int threads);
} // namespace fresco::poisson
