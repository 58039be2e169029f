// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <fresco/core/mesh.h>
#include <vector>
namespace fresco {
/// Inner node with up to four children, 128 bytes: two cache lines. Boxes as structure of arrays, so that one packet
/// instruction handles all four. Unused slots hold an empty box (low > high by the largest float).
struct alignas(64) TreeNode {
  Eigen::Array4f low[3], high[3]; ///< [axis][child]
  std::int32_t child[4];          ///< inner child: index of its node; leaf: index of its first triangle
  std::int32_t count[4];          ///< 0 for an inner child, else the number of triangles of the leaf
};

/// Corners of one triangle, in leaf order.
struct TreeTriangle {
  float corner[3][3]; ///< [corner][axis]
  std::int32_t face;  ///< index in the mesh
};

struct TriangleTreeData {
  std::vector<TreeNode> nodes; ///< nodes[0] is the root
  std::vector<TreeTriangle> triangles;
};

/// Bound on |coordinate|: squares of differences stay finite in single precision.
constexpr double largest_tree_coordinate = 1e18;
constexpr int largest_tree_depth = 64; ///< levels of nodes

/// Bounding volume hierarchy by the surface area heuristic (Wald 2007, "On fast construction of SAH-based bounding
/// volume hierarchies"), four children per node.
TriangleTreeData buildTriangleTree(std::vector<TreeTriangle> triangles, int threads);
} // namespace fresco
