// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/isosurface/edges.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <limits>
#include <utility>
namespace fresco::poisson {
namespace {
/// Nodes from one end of an edge to the other.
int stepAlong(int axis) { return axis == 0 ? 1 : axis == 1 ? brick_nodes : brick_nodes * brick_nodes; }

/// Offsets from the k-th of the four cells around an edge, k = 0..3, to the one whose lowest edge it is.
std::array<int, 3> offsetAround(int axis, int k)
{
  const int p = k & 1, q = k >> 1;
  return {axis == 0 ? 0 : p, axis == 0 ? p : axis == 1 ? 0 : q, axis == 2 ? 0 : q};
}
} // namespace

void requireVertices(Index count)
{
  require(count <= std::numeric_limits<int>::max(), "volumetric reconstruction: the surface has ", count,
          " vertices, more than 2^31 - 1: choose a smaller depth, or divide the points");
}

bool LevelSet::hasLeaves(int depth, Index brick) const
{
  if ((*chi)[depth].size() == 0)
    return false;
  const BrickLevel& level = tree->levels[depth];
  return (level.child_octants[brick] | level.remoteChildren(brick)) != 0xff;
}

CellPlace normalized(const Octree& tree, CellPlace c)
{
  const int o = offsetIndex(c.x >> 2, c.y >> 2, c.z >> 2);
  if (o != offset_self)
    c.brick = tree.levels[c.depth].neighbor(c.brick, o);
  c.x &= 3;
  c.y &= 3;
  c.z &= 3;
  return c;
}

int childBrick(const Octree& tree, const CellPlace& c)
{
  return tree.levels[c.depth].child(c.brick, octantOf(c.x, c.y, c.z));
}

int CrossedEdges::BrickEdges::count() const
{
  int n = 0;
  for (const std::uint64_t word : bits)
    n += bitCount(word);
  return n;
}

int CrossedEdges::BrickEdges::rank(int axis, int node) const
{
  const int last = axis * 2 + node / 64;
  int n = 0;
  for (int w = 0; w < last; ++w)
    n += bitCount(bits[w]);
  return n + bitCount(bits[last] & ((std::uint64_t(1) << (node & 63)) - 1));
}

CrossedEdges::CrossedEdges(const LevelSet& surface, int threads) : surface_(&surface)
{
  const Octree& tree = *surface.tree;
  bricks_.resize(tree.levels.size());
  for (int d = 2; d <= tree.depth; ++d) {
    if ((*surface.chi)[d].size() == 0)
      continue;
    const BrickLevel& level = tree.levels[d];
    bricks_[d].resize(level.codes.size());
    parallelFor(level.size(), threads, [&](Index b) {
      bricks_[d][b] = BrickEdges();
      if (level.owns(b))
        findCrossings(d, b);
    });
    level.ghosts.refresh(bricks_[d].data());
    numberEdges(bricks_[d], threads);
  }
  requireVertices(count_);
}

/// Counts by chunks of bricks first, so that the chunks can be numbered side by side.
void CrossedEdges::numberEdges(Bricks& bricks, int threads)
{
  std::vector<Index> first((bricks.size() + chunk_size - 1) / chunk_size);
  parallelRanges(
      bricks.size(), threads,
      [&](Index begin, Index end) {
        for (Index b = begin; b < end; ++b)
          first[begin / chunk_size] += bricks[b].count();
      },
      chunk_size);
  for (Index& f : first)
    f = std::exchange(count_, count_ + f);
  parallelRanges(
      bricks.size(), threads,
      [&](Index begin, Index end) {
        Index at = first[begin / chunk_size];
        for (Index b = begin; b < end; at += bricks[b++].count())
          bricks[b].first = at;
      },
      chunk_size);
}

void CrossedEdges::findCrossings(int depth, int brick)
{
  if (!surface_->hasLeaves(depth, brick))
    return;
  float chi[nodes_per_brick];
  (*surface_->chi)[depth].load(surface_->tree->levels[depth], brick, chi);
  bool inside[nodes_per_brick];
  int count = 0;
  for (int i = 0; i < nodes_per_brick; ++i)
    count += inside[i] = surface_->inside(chi[i]);
  if (count == 0 || count == nodes_per_brick)
    return;
  for (int axis = 0; axis < 3; ++axis)
    for (int z = 0; z < brick_nodes - (axis == 2); ++z)
      for (int y = 0; y < brick_nodes - (axis == 1); ++y)
        for (int x = 0; x < brick_nodes - (axis == 0); ++x) {
          const int node = nodeIndex(x, y, z);
          if (inside[node] == inside[node + stepAlong(axis)])
            continue;
          const EdgePlace edge{depth, brick, axis, x, y, z};
          if (ownerOf(edge).brick == edge.brick && !isSubdivided(edge))
            bricks_[depth][brick].set(axis, node);
        }
}

bool CrossedEdges::isSubdivided(const EdgePlace& edge) const
{
  const Octree& tree = *surface_->tree;
  if (edge.depth == tree.depth)
    return false;
  for (int k = 0; k < 4; ++k) {
    const auto [dx, dy, dz] = offsetAround(edge.axis, k);
    const CellPlace cell = normalized(tree, {edge.depth, edge.brick, edge.x - dx, edge.y - dy, edge.z - dz});
    if (cell.brick >= 0 && !tree.levels[cell.depth].isLeaf(cell.brick, octantOf(cell.x, cell.y, cell.z)))
      return true;
  }
  return false;
}

/// Of the bricks around the edge, the one highest on the first, then on the second axis across it.
EdgePlace CrossedEdges::ownerOfFaceEdge(const EdgePlace& edge) const
{
  const int first = edge.axis == 0 ? 1 : 0, second = edge.axis == 2 ? 1 : 2;
  const int at[3] = {edge.x, edge.y, edge.z};
  const BrickLevel& level = surface_->tree->levels[edge.depth];
  // Offsets of the upper bricks on both axes; the lower ones are one less where the edge lies between two bricks.
  const int up_first = at[first] == brick_cells, up_second = at[second] == brick_cells;
  const int down_first = up_first - (at[first] % brick_cells == 0),
            down_second = up_second - (at[second] % brick_cells == 0);
  for (int p = up_first; p >= down_first; --p)
    for (int q = up_second; q >= down_second; --q) {
      int offset[3] = {0, 0, 0};
      offset[first] = p;
      offset[second] = q;
      const int n = level.neighbor(edge.brick, offsetIndex(offset[0], offset[1], offset[2]));
      if (n >= 0)
        return {edge.depth,
                n,
                edge.axis,
                edge.x - brick_cells * offset[0],
                edge.y - brick_cells * offset[1],
                edge.z - brick_cells * offset[2]};
    }
  return edge;
}

float CrossedEdges::lowerEnd(const EdgePlace& edge) const
{
  return surface_->at(edge.depth, edge.brick, edge.x, edge.y, edge.z);
}

float CrossedEdges::upperEnd(const EdgePlace& edge) const
{
  return surface_->at(edge.depth, edge.brick, edge.x + (edge.axis == 0), edge.y + (edge.axis == 1),
                      edge.z + (edge.axis == 2));
}

/// Replaces a subdivided edge by that half of it which the level set crosses; false if it is not subdivided.
bool CrossedEdges::finerHalf(EdgePlace& edge) const
{
  const Octree& tree = *surface_->tree;
  if (edge.depth == tree.depth)
    return false;
  for (int k = 0; k < 4; ++k) {
    const auto [dx, dy, dz] = offsetAround(edge.axis, k);
    const CellPlace cell = normalized(tree, {edge.depth, edge.brick, edge.x - dx, edge.y - dy, edge.z - dz});
    const int child = cell.brick < 0 ? -1 : childBrick(tree, cell);
    if (child < 0)
      continue;
    EdgePlace half{edge.depth + 1,       child, edge.axis, 2 * (cell.x % 2 + dx), 2 * (cell.y % 2 + dy),
                   2 * (cell.z % 2 + dz)};
    if (surface_->inside(lowerEnd(half)) == surface_->inside(upperEnd(half)))
      (edge.axis == 0 ? half.x : edge.axis == 1 ? half.y : half.z) += 1;
    edge = half;
    return true;
  }
  return false;
}

int CrossedEdges::vertexOn(EdgePlace edge) const
{
  while (finerHalf(edge)) {
  }
  const EdgePlace owner = ownerOf(edge);
  const BrickEdges& edges = bricks_[owner.depth][owner.brick];
  return edges.first + edges.rank(owner.axis, nodeIndex(owner.x, owner.y, owner.z));
}

/// @param chi at the nodes of the edge's brick
Eigen::Vector3f CrossedEdges::position(const EdgePlace& edge, const float* chi) const
{
  const int node = nodeIndex(edge.x, edge.y, edge.z);
  const float t = crossing(chi[node], chi[node + stepAlong(edge.axis)], surface_->value);
  const auto corner = surface_->tree->levels[edge.depth].corner(edge.brick);
  Eigen::Vector3f p(corner[0] + edge.x, corner[1] + edge.y, corner[2] + edge.z);
  p[edge.axis] += t;
  return p * std::ldexp(1.f, surface_->tree->depth - edge.depth);
}

void CrossedEdges::fillPositions(int threads, Points& positions) const
{
  for (int d = 2; d <= surface_->tree->depth; ++d)
    parallelFor(bricks_[d].size(), threads, [&](int b) {
      const BrickEdges& edges = bricks_[d][b];
      if (edges.count() == 0)
        return;
      float chi[nodes_per_brick];
      (*surface_->chi)[d].load(surface_->tree->levels[d], b, chi);
      Index at = edges.first;
      for (int w = 0; w < 6; ++w)
        for (int bit = 0; edges.bits[w] >> bit != 0; ++bit) {
          if (edges.bits[w] >> bit & 1) {
            const int node = (w & 1) * 64 + bit;
            positions.col(at++) = position({d, b, w / 2, node % 5, node / 5 % 5, node / 25}, chi);
          }
          if (bit == 63)
            break;
        }
    });
}
} // namespace fresco::poisson
