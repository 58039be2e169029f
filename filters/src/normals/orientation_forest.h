// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/types.h>
#include <fresco/search/neighbors.h>
#include <utility>
#include <vector>
namespace fresco::filters {
/// Disjoint sets (union by size, so that paths stay short) of elements that also have a sign against the root
/// of their set.
class ParityUnionFind {
public:
  explicit ParityUnionFind(Index n);
  Index root(Index i) const
  {
    while (parent_[i] != i)
      i = parent_[i];
    return i;
  }
  int sign(Index i) const
  {
    bool turned = false;
    for (; parent_[i] != i; i = parent_[i])
      turned ^= turned_[i] != 0;
    return turned ? -1 : 1;
  }
  /// Joins the sets of i and j, in which the signs of i and j then are the same or opposite.
  void join(Index i, Index j, bool same);

private:
  std::vector<int> parent_, size_;
  std::vector<char> turned_; ///< against the parent
};

/// The points with normals, in the order of a tree.
struct NormalGraph {
  std::vector<int> columns;
  Points points; ///< projected to the plane through the mean of their neighbours: without noise across the surface
  Points normals;
  NeighborLists lists;
  Eigen::VectorXf areas;
};
NormalGraph makeNormalGraph(const Points& points, const Points& normals, int threads);

/// Minimum spanning forest of the graph by what is certain that normals agree: signs within its trees.
struct OrientationForest {
  ParityUnionFind parts;
  std::vector<int>
      patches; ///< by point: a number that all those share who are joined by edges that are all but certain
};
OrientationForest spanningForest(const NormalGraph& graph, int threads);

/// Turns that make the volume of each part positive (its flux; about the part's own mean, so that position does not
/// matter), or, of parts that enclose none, the largest component of the mean normal.
std::vector<char> partTurns(const NormalGraph& graph, const ParityUnionFind& parts);
} // namespace fresco::filters
