// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
namespace fresco::poisson {
/// Bits of the axes on which node (x, y, z), each 0..4, lies at the upper end of its brick; the node belongs to the
/// neighbour in that direction where there is one.
constexpr int upperAxes(int x, int y, int z) { return x >> 2 | y >> 2 << 1 | z >> 2 << 2; }

/// Offset of the neighbour in the direction of upperAxes().
constexpr int upperOffset(int axes) { return offsetIndex(axes & 1, axes >> 1 & 1, axes >> 2); }

/// Whether brick `b` is the one that holds its node (x, y, z), each 0..4.
inline bool holdsNode(const BrickLevel& level, Index b, int x, int y, int z)
{
  const int axes = upperAxes(x, y, z);
  return axes == 0 || (level.rims[b].parts >> axes & 1) != 0;
}

/// From the first node of a part of the rim, those with the same upperAxes(), to (x, y, z); x is fastest.
constexpr int rimIndex(int axes, int x, int y, int z)
{
  const int step_y = axes & 1 ? 1 : brick_cells, step_z = axes & 2 ? step_y : step_y * brick_cells;
  return (axes & 1 ? 0 : x) + (axes & 2 ? 0 : y * step_y) + (axes & 4 ? 0 : z * step_z);
}

/// From the first node of a brick's rim to a part of it. @param parts Rim::parts
int rimPart(unsigned parts, int axes);

/// Nodes on the upper faces of a brick, part by part as if all were its rim, from all by nodeIndex().
void copyUpperNodes(const float* nodes, float* upper);
inline int upperPart(int axes) { return rimPart(0xff, axes); }

/// Sets the rims of a level that has its neighbours.
void findRims(BrickLevel& level, int threads);

/// Where a field keeps a node; neither if no brick holds it.
struct NodePlace {
  Index own = -1, rim = -1;
};

/// One float per node of a level: for each brick its own nodes, by ownIndex(), and its rim.
class NodeField {
public:
  NodeField() = default;
  explicit NodeField(const BrickLevel& level)
      : size_(level.size()), own_(level.codes.size() * own_nodes), rim_(level.rim_nodes)
  {}
  NodeField(const BrickLevel& level, int threads) : NodeField(level) { clear(threads); }
  void clear(int threads);
  NodeField copy(int threads) const;
  /// The rim's nodes have no value from now on: they are read as 0.
  void releaseRim();

  Index size() const { return size_; }
  float* own(Index b) { return own_.data() + b * own_nodes; }
  const float* own(Index b) const { return own_.data() + b * own_nodes; }
  /// Part of a brick's rim, by rimIndex(); nullptr if it was released.
  const float* rim(const BrickLevel& level, Index b, int axes) const
  {
    const Rim rim = level.rims[b];
    return rim_.empty() ? nullptr : rim_.data() + rim.first + rimPart(rim.parts, axes);
  }
  float* rim(const BrickLevel& level, Index b, int axes)
  {
    return const_cast<float*>(static_cast<const NodeField*>(this)->rim(level, b, axes));
  }
  float& at(const NodePlace& place) { return place.own >= 0 ? own_[place.own] : rim_[place.rim]; }
  float at(const NodePlace& place) const { return place.own >= 0 ? own_[place.own] : rim_[place.rim]; }

  /// Value at node (x, y, z) of brick `b`, each 0..4.
  float value(const BrickLevel& level, Index b, int x, int y, int z) const;
  /// Values at all nodes of a brick, by nodeIndex().
  void load(const BrickLevel& level, Index b, float* nodes) const;
  /// The same but 0 at nodes that a neighbour holds.
  void loadHeld(const BrickLevel& level, Index b, float* nodes) const;
  /// Sets the nodes that a brick holds.
  void store(const BrickLevel& level, Index b, const float* nodes);
  /// Adds factor * nodes to those that a brick holds.
  void add(const BrickLevel& level, Index b, float factor, const float* nodes);

private:
  Index size_ = 0;
  Array<float> own_, rim_;
};

/// Fills the ghosts from their owners: all nodes.
void refreshGhosts(const BrickLevel& level, NodeField& field);
/// Own nodes of the ghosts become NaN if Ghosts::poison says so. @param color of BrickLevel::colors, -1 = all
void poisonGhosts(const BrickLevel& level, NodeField& field, int color = -1);
/// Only their own nodes. @param color of BrickLevel::colors, -1 = all
void refreshOwnNodes(const BrickLevel& level, NodeField& field, int color = -1);

/// Gives a field of a depth that all ranks have from rank 0 to all.
void broadcastNodes(Exchange& exchange, const BrickLevel& level, NodeField& field);

/// The place of the node with coordinates x, y, z in -4..7 relative to brick `b`: in the brick whose own it is, else in
/// the rim of one.
NodePlace findNodeAround(const BrickLevel& level, Index b, int x, int y, int z);
inline NodePlace findNode(const BrickLevel& level, Index b, int x, int y, int z)
{
  if (((x | y | z) & ~3) == 0)
    return {b * own_nodes + ownIndex(x, y, z), -1};
  return findNodeAround(level, b, x, y, z);
}
} // namespace fresco::poisson
