// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/node_field.h"
#include <Eigen/Core>
#include <algorithm>
#include <vector>
namespace fresco::poisson {
/// chi on the leaves of the octree. Where leaves of different size meet, the values of the finer one are interpolated
/// from the coarser one, so chi is continuous and linear along each edge of each leaf.
struct LevelSet {
  const Octree* tree;
  const std::vector<NodeField>* chi; ///< by depth; empty where all cells are refined
  float value;                       ///< of chi on the surface; smaller inside

  bool inside(float v) const { return v < value; }
  float at(int depth, Index brick, int x, int y, int z) const
  {
    return (*chi)[depth].value(tree->levels[depth], brick, x, y, z);
  }
  bool hasLeaves(int depth, Index brick) const;
};

/// Where a value is crossed from a to b, 0..1; off the ends, so that no two vertices coincide.
inline float crossing(float a, float b, float value)
{
  constexpr float end_margin = 1e-3f;
  return std::clamp((value - a) / (b - a), end_margin, 1.f - end_margin);
}

/// @throws std::invalid_argument if so many vertices cannot be numbered
void requireVertices(Index count);

/// Cell (x, y, z) of a brick.
struct CellPlace {
  int depth, brick, x, y, z;
};

/// The edge that leaves node (x, y, z) of a brick towards +axis.
struct EdgePlace {
  int depth, brick, axis, x, y, z;
};

/// The same cell, (x, y, z) each -4..7, as one of the brick that holds it; brick = -1 where there is none.
CellPlace normalized(const Octree& tree, CellPlace c);

/// Brick of the child cells of a cell, -1 if the cell is a leaf.
int childBrick(const Octree& tree, const CellPlace& c);

/// The edges that the level set crosses, each once: the finest ones where leaves of different size share an edge. Each
/// carries a vertex.
class CrossedEdges {
public:
  CrossedEdges(const LevelSet& surface, int threads);

  Index vertexCount() const { return count_; }

  /// Vertex on a crossed edge of a leaf.
  int vertexOn(EdgePlace edge) const;

  /// Positions of all vertices, 3 x vertexCount(), in finest cells.
  void fillPositions(int threads, Points& positions) const;

  /// visit(depth, brick, first vertex, number of vertices) for each brick that has vertices.
  template <typename Visit>
  void forEachBrick(const Visit& visit) const
  {
    for (std::size_t d = 0; d < bricks_.size(); ++d)
      for (std::size_t b = 0; b < bricks_[d].size(); ++b)
        if (const int n = bricks_[d][b].count(); n > 0)
          visit(d, b, bricks_[d][b].first, n);
  }

private:
  static constexpr std::size_t words = 2; ///< of 64 edges, per axis
  struct BrickEdges {
    std::uint64_t bits[3 * words] = {};
    int first = 0;
    int count() const;
    void set(int axis, int node) { bits[axis * 2 + node / 64] |= std::uint64_t(1) << (node & 63); }
    int rank(int axis, int node) const; ///< edges before this one
  };
  using Bricks = Array<BrickEdges>;
  void numberEdges(Bricks& bricks, int threads);
  void findCrossings(int depth, int brick);
  bool isSubdivided(const EdgePlace& edge) const;
  EdgePlace ownerOf(const EdgePlace& edge) const
  {
    const bool within = (edge.axis == 0 || edge.x < brick_cells) && (edge.axis == 1 || edge.y < brick_cells) &&
                        (edge.axis == 2 || edge.z < brick_cells);
    return within ? edge : ownerOfFaceEdge(edge);
  }
  EdgePlace ownerOfFaceEdge(const EdgePlace& edge) const;
  float lowerEnd(const EdgePlace& edge) const; ///< chi there
  float upperEnd(const EdgePlace& edge) const;
  bool finerHalf(EdgePlace& edge) const;
  Eigen::Vector3f position(const EdgePlace& edge, const float* chi) const;

  const LevelSet* surface_;
  std::vector<Bricks> bricks_; ///< by depth
  Index count_ = 0;
};
} // namespace fresco::poisson
