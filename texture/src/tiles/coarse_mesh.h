// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
namespace fresco::texture {
/// The surface with at most so many faces, without attributes; the mesh itself if it has no more. Vertices in one cell
/// of a grid become one, at the place with the least squared distances from the planes of the faces around: Lindstrom
/// 2000, "Out-of-Core Simplification of Large Polygonal Models". Edges of the surface stay where they are; what is
/// thinner than a cell collapses.
TriangleMesh coarseMesh(const TriangleMesh& mesh, Index most_faces);
} // namespace fresco::texture
