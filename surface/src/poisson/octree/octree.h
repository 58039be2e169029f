// SPDX-License-Identifier: BSD-3-Clause
#pragma once
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
/// Floats reserved for the nodes of a brick: whole cache lines.
constexpr int brick_stride = 128;

/// Place of node (x, y, z), each 0..4, among the nodes of its brick.
constexpr int nodeIndex(int x, int y, int z) { return x + brick_nodes * (y + brick_nodes * z); }

/// Place of the neighbour in direction (dx, dy, dz), each -1..1.
constexpr int offsetIndex(int dx, int dy, int dz) { return (dx + 1) + 3 * (dy + 1) + 9 * (dz + 1); }
constexpr int offset_self = offsetIndex(0, 0, 0);

/// Octant (bits x, y, z) of the brick that holds cell (x, y, z), each 0..3.
constexpr int octantOf(int x, int y, int z) { return (x >> 1) | (y >> 1) << 1 | (z >> 1) << 2; }

/// Consecutive bricks begin..end - 1.
struct BrickRun {
  int begin, end;
};

/// The bricks of one octree depth, sorted by Morton code. A brick covers 4^3 cells of side 1 / 2^depth.
struct BrickLevel {
  int depth = 0;
  std::vector<std::uint64_t> codes;     ///< Morton code of the brick's coordinates
  Array<std::array<int, 27>> neighbors; ///< by offsetIndex(); -1 where there is none
  Array<int> parents;                   ///< index into the coarser level; -1 at the coarsest
  Array<std::array<int, 8>> children;   ///< index into the finer level by octant; -1 where the cells are leaves
  /// Blocks of 4^3 bricks, by the octant that a block is in the block of 8^3 around it. Those of one colour never
  /// touch.
  std::array<std::vector<BrickRun>, 8> colors;

  Index size() const { return codes.size(); }
  /// Octant of its parent (bits x, y, z) that brick `b` covers.
  int octant(Index b) const { return codes[b] & 7; }
  /// Coordinates of the lower node of brick `b`, in cells of this depth.
  std::array<int, 3> corner(Index b) const;
  Eigen::Vector3f origin(Index b) const;
};

/// levels[d] for d = 2..depth (0 and 1 are empty).
struct Octree {
  int depth = 0, full_depth = 0;
  std::vector<BrickLevel> levels;
};

/// @param cell_codes sorted Morton codes of the finest cells that hold samples
/// @param full_depth all bricks exist down to this depth, 2..depth
Octree buildOctree(const Array<std::uint64_t>& cell_codes, int depth, int full_depth, int threads);

/// @param codes by depth, from 2 on, sorted; the parent of each brick must be there
Octree linkBricks(std::vector<std::vector<std::uint64_t>> codes, int full_depth, int threads);

/// Bricks per depth that buildOctree() would make.
std::vector<Index> countBricks(const Array<std::uint64_t>& cell_codes, int depth, int full_depth, int threads);

/// One float per node and brick of a level. The upper faces are copies of the neighbours' values where there are
/// neighbours.
class NodeField {
public:
  NodeField() = default;
  explicit NodeField(Index bricks) : size_(bricks), data_(bricks * brick_stride) {}
  NodeField(Index bricks, int threads) : NodeField(bricks) { clear(threads); }
  void clear(int threads);
  float* brick(Index b) { return data_.data() + b * brick_stride; }
  const float* brick(Index b) const { return data_.data() + b * brick_stride; }
  Index size() const { return size_; }

private:
  Index size_ = 0;
  Array<float> data_;
};

/// A node as seen from a brick, which may belong to one of its neighbours.
struct NodePlace {
  int brick = -1; ///< -1 where no brick holds the node
  int index = 0;  ///< within the brick
};

/// The brick that holds the node with coordinates x, y, z in -4..8 relative to brick `b`: the one whose lower part it
/// is, else one that has it on an upper face.
NodePlace findNode(const BrickLevel& level, Index b, int x, int y, int z);

/// Whether brick `b` is the one that holds its node (x, y, z), each 0..4: a node on an upper face belongs to the
/// neighbour.
inline bool holdsNode(const BrickLevel& level, Index b, int x, int y, int z)
{
  const int o = offsetIndex(x >> 2, y >> 2, z >> 2);
  return o == offset_self || level.neighbors[b][o] < 0;
}

/// Adds the values on the upper faces of the neighbours to the nodes they are copies of, then does as syncFaces().
void sumFaces(const BrickLevel& level, NodeField& field, int threads);

/// Copies the values of the neighbours onto the upper faces.
void syncFaces(const BrickLevel& level, NodeField& field, int threads);
} // namespace fresco::poisson
