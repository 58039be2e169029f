// SPDX-License-Identifier: BSD-3-Clause
#include "filling/creases.h"
#include <fresco/core/grouped.h>
#include <fresco/core/union_find.h>
namespace fresco::texture {
namespace {
/// visit(patch, side, patch beyond it) of each edge that is no crease.
template <typename Visit>
void forSmoothEdges(const PatchMesh& patches, const Visit& visit)
{
  for (Index i = 0; i < patches.size(); ++i)
    for (int side = 0; side < 3; ++side)
      if (const int other = patches.neighbors(side, i);
          other > i && patches.normals.col(i).dot(patches.normals.col(other)) > crease_cosine)
        visit(i, side, other);
}

/// Sets of corners 3 * patch + k.
UnionFind joinOverEdges(const PatchMesh& patches)
{
  UnionFind sets(patches.faces.size());
  forSmoothEdges(patches, [&](Index i, int side, Index other) {
    for (const int k : {side, (side + 1) % 3})
      for (int j = 0; j < 3; ++j)
        if (patches.faces(j, other) == patches.faces(k, i))
          sets.join(3 * i + k, 3 * other + j);
  });
  return sets;
}
} // namespace

SmoothCorners joinSmoothCorners(const PatchMesh& patches)
{
  UnionFind sets = joinOverEdges(patches);
  SmoothCorners out{Eigen::Matrix3Xi(3, patches.size()), {}, {}};
  const auto roots =
      grouped(patches.faces.size(), patches.vertices.cols(), [&](Index c) { return patches.faces.data()[c]; });
  for (Index v = 0; v < patches.vertices.cols(); ++v)
    for (Index r = roots.begin[v]; r < roots.begin[v + 1]; ++r) {
      const int corner = roots.list[r];
      const Index root = sets.root(corner);
      if (root == corner) // the lowest of its set, thus met first
        out.vertex.push_back(v);
      out.node.data()[corner] = root == corner ? int(out.vertex.size()) - 1 : out.node.data()[root];
    }
  out.normals = Points::Zero(3, out.size());
  for (Index i = 0; i < patches.size(); ++i)
    for (int k = 0; k < 3; ++k)
      out.normals.col(out.node(k, i)) += patches.areas[i] * patches.normals.col(i);
  out.normals.colwise().normalize();
  return out;
}

std::vector<int> smoothPieces(const PatchMesh& patches)
{
  UnionFind sets(patches.size());
  forSmoothEdges(patches, [&](Index i, int, Index other) { sets.join(i, other); });
  std::vector<int> pieces(patches.size());
  for (Index i = 0; i < patches.size(); ++i)
    pieces[i] = sets.root(i);
  return pieces;
}
} // namespace fresco::texture
