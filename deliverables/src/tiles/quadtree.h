// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
#include <vector>
namespace fresco::deliverables {
/// A part of a quadtree over x and y of the faces of a mesh.
struct Quarter {
  int first = 0, last = 0; ///< leaves below it, in the order of leafFaces
  int depth = 0;
  std::vector<int> children; ///< quarters; none of a leaf
};

struct Quadtree {
  std::vector<Quarter> quarters;            ///< the root first, each before its children
  std::vector<std::vector<int>> leaf_faces; ///< each face of the mesh once, by its middle
  /// V: first and last leaf that a vertex lies in.
  std::vector<int> first_leaf, last_leaf;
};

/// @param most faces of a leaf, >= 1, unless they all lie in one place
Quadtree quadtreeOf(const TriangleMesh& mesh, Index most);
} // namespace fresco::deliverables
