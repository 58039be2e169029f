// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstdint>
#include <fresco/core/export.h>
#include <fresco/search/batch_knn.h>
#include <fresco/search/neighbors.h>
#include <memory>
#include <vector>
namespace fresco {
/// Neighbours of consecutive points in two bytes each: numbers within a table of leaves.
struct GroupLists {
  Index begin = 0, end = 0; ///< positions; whole leaves but for the last
  std::vector<int> leaves;  ///< sets of 8 consecutive positions: of the points, in order, and their neighbours
  const std::uint16_t* codes = nullptr; ///< per neighbour: 8 * place in `leaves` + place in the leaf
  std::vector<int> starts;              ///< of the lists in `codes`, and the end; empty where all lists are as long
  int length = 0;                       ///< of every list, then

  std::size_t start(Index at) const { return starts.empty() ? at * length : starts[at]; }
  const std::uint16_t* list(Index i) const { return codes + start(i - begin); }
  std::size_t count(Index i) const { return start(i - begin + 1) - start(i - begin); }
  std::uint16_t codeOf(Index i) const { return i - begin; } ///< of a point of the group
  Index position(std::uint16_t code) const { return 8 * Index{leaves[code / 8u]} + code % 8u; }
};

/// Points in an order good for loops, eight to a leaf, with their neighbours.
struct FRESCO_EXPORT Neighborhoods {
  /// Of each point: 16 bits number the points of 8192 leaves.
  static constexpr int most_neighbors = 1000;
  /// Leaves of a group such that the leaves of all neighbours can be numbered.
  static Index groupLeaves(Index neighbors) { return std::clamp<Index>(most_neighbors / neighbors, 1, 8); }

  std::unique_ptr<PointTree> tree;      ///< null for images
  std::vector<float> image_coordinates; ///< of images, as PointTree::leafCoordinates()
  std::vector<int> image_columns;
  std::vector<std::uint16_t> codes; ///< of all groups: one block, which is given back as such
  std::vector<GroupLists> groups;   ///< all points, in order
  std::vector<int> group_of_leaf;

  Index size() const { return groups.empty() ? 0 : groups.back().end; }
  const float* coordinates() const { return tree ? tree->leafCoordinates() : image_coordinates.data(); }
  int column(Index i) const { return (tree ? tree->columns() : image_columns)[i]; }
  Eigen::Vector3f point(Index i) const
  {
    const float* leaf = coordinates() + i / 8 * 24 + i % 8;
    return {leaf[0], leaf[8], leaf[16]};
  }
  const GroupLists& groupOf(Index i) const { return groups[group_of_leaf[i / 8]]; }
  void numberGroups();
};

/// Collects the lists of a group.
class FRESCO_EXPORT GroupEncoder {
public:
  void begin(Index begin, Index end);
  /// Adds the list of the next point.
  /// @param codes 8 * place in a table of leaves + place in the leaf
  void add(const int* codes, std::size_t count);
  /// Puts another list of the same length in place of that of point i.
  void replace(Index i, const int* codes, std::size_t count);
  /// @param table of the codes @param codes where they are to be kept @return with the leaves in use alone
  GroupLists finish(const std::vector<int>& table, std::uint16_t* codes);

private:
  GroupLists lists_;
  std::vector<int> codes_, places_;
};

/// Makes groups of the lists of all points, which are positions, at most most_neighbors each.
FRESCO_EXPORT void encodeLists(const NeighborLists& lists, int threads, Neighborhoods& all);
} // namespace fresco
