// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/isosurface/edges.h"
#include "poisson/octree/runs.h"
#include <fresco/core/scratch_space.h>
namespace fresco::poisson {
/// Vertices first..first + count - 1 lie on edges of a brick, or in its cells.
struct VertexRange {
  int depth;
  Index brick;
  Index first, count;
};

struct IsoSurface {
  Points vertices; ///< in finest cells, from the cube's corner
  Faces faces;     ///< counter-clockwise seen from where chi is larger
  std::vector<VertexRange> ranges;
  FileBacking vertices_backing, faces_backing; ///< to be ended before these are resized
};

/// Marching cubes over the leaves of the octree. On the faces of a leaf it takes the polygons' sides from the finest
/// leaves beyond (Kazhdan, Klein, Dalal & Hoppe 2007, "Unconstrained Isosurface Extraction on Arbitrary Octrees").
/// Closed, 2-manifold and consistently oriented, except where the level set leaves the cube.
/// @param chi by depth, freed as soon as it is not needed any more. @param value of chi on the surface
IsoSurface extractIsoSurface(const Octree& tree, std::vector<NodeField>&& chi, float value, int threads);

/// What belongs to this rank of a surface that several ranks extract: runs that are to be ordered by depth, brick and
/// cell. The vertices on edges of shared depths, which all ranks have, are rank 0's.
struct OwnParts {
  Index edge_vertices = 0; ///< all the rank has; centre vertices, all its own, follow
  std::vector<KeyedRun> extras, faces;
  static std::uint64_t keyOfDepth(int depth, std::uint64_t within) { return std::uint64_t(depth) << 56 | within; }
};

/// The leaf cells of own atoms. Vertices are numbered within this rank; those on edges of ghosts are among them.
IsoSurface extractIsoSurface(const Octree& tree, std::vector<NodeField>&& chi, float value, int threads, OwnParts& own);
} // namespace fresco::poisson
