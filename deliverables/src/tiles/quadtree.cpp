// SPDX-License-Identifier: BSD-3-Clause
#include "tiles/quadtree.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
namespace fresco::deliverables {
namespace {
constexpr int deepest = 16; ///< levels: parts of a kilometre of 2 cm

class Builder {
public:
  Builder(const TriangleMesh& mesh, Index most) : most_(most)
  {
    middles_.resize(2, mesh.faceCount());
    for (Index f = 0; f < mesh.faceCount(); ++f)
      middles_.col(f) =
          ((faceCorner(mesh, f, 0) + faceCorner(mesh, f, 1) + faceCorner(mesh, f, 2)) / 3).head<2>().cast<float>();
  }

  Quadtree build()
  {
    std::vector<int> all(middles_.cols());
    std::iota(all.begin(), all.end(), 0);
    const Eigen::Vector2f low = middles_.rowwise().minCoeff(), high = middles_.rowwise().maxCoeff();
    add(std::move(all), low, (high - low).maxCoeff(), 0);
    return std::move(tree_);
  }

private:
  int add(std::vector<int> faces, const Eigen::Vector2f& low, float side, int depth)
  {
    const int number = int(tree_.quarters.size()), first = int(tree_.leaf_faces.size());
    tree_.quarters.push_back({first, first, depth, {}});
    if (Index(faces.size()) <= most_ || depth == deepest) {
      tree_.leaf_faces.push_back(std::move(faces));
      return number;
    }
    std::vector<int> parts[4];
    const Eigen::Vector2f middle = low.array() + side / 2;
    for (const int f : faces)
      parts[(middles_(0, f) >= middle.x() ? 1 : 0) + (middles_(1, f) >= middle.y() ? 2 : 0)].push_back(f);
    faces = {};
    for (int k = 0; k < 4; ++k)
      if (!parts[k].empty()) {
        const Eigen::Vector2f corner(k % 2 ? middle.x() : low.x(), k / 2 ? middle.y() : low.y());
        const int child = add(std::move(parts[k]), corner, side / 2, depth + 1);
        tree_.quarters[number].children.push_back(child);
      }
    tree_.quarters[number].last = int(tree_.leaf_faces.size()) - 1;
    return number;
  }

  Index most_;
  Eigen::Matrix2Xf middles_;
  Quadtree tree_;
};
} // namespace

Quadtree quadtreeOf(const TriangleMesh& mesh, Index most)
{
  Quadtree tree = Builder(mesh, most).build();
  tree.first_leaf.assign(mesh.vertexCount(), int(tree.leaf_faces.size()));
  tree.last_leaf.assign(mesh.vertexCount(), -1);
  for (std::size_t leaf = 0; leaf < tree.leaf_faces.size(); ++leaf)
    for (const int f : tree.leaf_faces[leaf])
      for (const int v : mesh.faces.col(f)) {
        tree.first_leaf[v] = std::min(tree.first_leaf[v], int(leaf));
        tree.last_leaf[v] = std::max(tree.last_leaf[v], int(leaf));
      }
  return tree;
}
} // namespace fresco::deliverables
