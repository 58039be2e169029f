// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/array.h>
#include <fresco/core/mesh.h>
#include <vector>
namespace fresco::texture {
/// Around a tile: messages of view selection have faded so far away, offsets of levelling by half, and colours of unseen
/// surface go on from there.
constexpr float halo_patches = 12;

/// The faces of a mesh in groups of neighbours, by bisection of their middles.
struct MeshTiles {
  Array<int> order;                       ///< F, faces tile by tile, ascending within each
  std::vector<Index> begin;               ///< T + 1, into `order`
  std::vector<Eigen::AlignedBox3f> boxes; ///< of the faces of each tile

  Index count() const { return boxes.size(); }
};

/// @param most_faces of a tile, > 0; more only where so many have their middles at one place
MeshTiles cutIntoTiles(const TriangleMesh& mesh, Index most_faces);

/// A tile with what lies around it.
struct TileMesh {
  TriangleMesh mesh; ///< the tile's own faces first, those around after them; corners at equal places are one
  Index own = 0;     ///< number of own faces
  /// A face around the tile: number `slot` in the order of its own tile.
  struct Around {
    int tile, slot;
  };
  std::vector<Around> around; ///< of the faces from `own` on
};

/// @param halo distance from the tile's box up to which faces around it are taken in, mesh units; negative = none
TileMesh tileMesh(const TriangleMesh& mesh, const MeshTiles& tiles, Index tile, float halo);

/// Mesh of some faces, without normals and fields.
TriangleMesh meshOf(const TriangleMesh& mesh, const std::vector<int>& faces);

/// Mean length of the edges, longer ones counted as `longest`.
double meanEdge(const TriangleMesh& mesh, float longest);
} // namespace fresco::texture
