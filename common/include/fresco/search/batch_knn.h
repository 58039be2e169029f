// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/search/neighbors.h>
#include <functional>
namespace fresco {
namespace search {
struct KnnKernels;
struct KnnPoints;
} // namespace search

/// Search for the k nearest neighbours (or those within a radius) of all points of a subtree together. One descent of
/// the tree finds the leaves around the whole group; of these, the leaves near one leaf of the group are picked by
/// their boxes; each point is then compared with the points in them, eight at a time.
///
/// This is own code since nanoflann takes twice as long for normals and smoothing: docs/measurements/search.md.
///
/// Points are named by codes: 8 * place of their leaf in leaves() + place in the leaf.
class FRESCO_EXPORT BatchKnn {
public:
  explicit BatchKnn(const PointTree& tree);

  /// Makes the points of leaves begin .. end - 1 the group.
  void enter(Index begin, Index end);
  Index begin() const { return begin_; } ///< first position
  Index end() const { return end_; }     ///< behind the last position

  /// Estimate of the distance to the `k`-th neighbour of a point of the group, from the group's extent. Right where
  /// its points are spread evenly over a flat piece of surface.
  float expectedReach(int k) const;

  /// Finds the leaves within `reach` of the box around the points; none where there are more than `most`.
  void gather(float reach, std::size_t most);
  /// The leaves gathered, ascending, then those of farther neighbours found since.
  const std::vector<int>& leaves() const { return leaves_; }
  int position(int code) const { return 8 * leaves_[code / 8] + code % 8; }

  /// The code of any point of the tree; leaves() grows if its leaf is new.
  int codeOf(int position);

  /// Finds the `k` nearest of point i, itself included; ordered() and sum() read them. Of equally far ones those of the
  /// smallest positions count.
  /// @param k <= tree.size()
  void nearest(Index i, int k);
  /// Writes the positions of those found, by distance, then position.
  void ordered(int* positions);
  /// Sums over the offsets of those found from the point: x, y, z, xx, xy, xz, yy, yz, zz, and the largest squared
  /// distance. @return their codes, about in order of position
  const int* sum(float* sums);

  /// Positions of the gathered points that are no farther from point i than `radius`, ascending. @return how many
  std::size_t within(Index i, float radius);
  const std::vector<int>& positions() const { return position_; }

  /// Keeps every m-th of the gathered points for keptWithin(), so many that on a surface about `wanted` of them lie
  /// within `radius` of each.
  void thin(float radius, int wanted);
  /// Finds the points kept that are no farther from point i than `radius`; sum() reads them. @return how many
  std::size_t keptWithin(Index i, float radius);

private:
  search::KnnPoints foundPoints();
  void prepare();
  void makeRoom(std::size_t leaf_count);
  void focus(Index leaf, float reach);
  bool choose(Index i, int k, float bound);
  void chooseByKeys(Index i);

  const PointTree& tree_;
  const search::KnnKernels& kernels_;
  Index begin_ = 0, end_ = 0, first_leaf_ = 0;
  Eigen::Vector3f low_, high_;
  float reach_ = 0;                        ///< all points so far around the box are gathered
  std::vector<int> leaves_;                ///< of the tree
  std::size_t gathered_ = 0;               ///< of leaves_; the others are not in coordinates_
  bool prepared_ = false;                  ///< coordinates_ and boxes_ are there
  std::vector<float> coordinates_, boxes_; ///< of the leaves gathered
  Index focus_leaf_ = -1;                  ///< to whose points the search is narrowed
  float focus_reach_ = 0;
  std::vector<int> focus_, focus_leaves_; ///< places in leaves_, and leaves
  std::size_t focus_count_ = 0;
  float last_ = 0;                         ///< squared distance of the k-th of the point before
  std::vector<float> squared_, x_, y_, z_; ///< points found near one
  std::vector<int> position_, ranks_, chosen_;
  std::size_t count_ = 0;               ///< of them
  float limit_ = 0;                     ///< of the squared distance of those chosen
  std::vector<float> thin_coordinates_; ///< as coordinates_, of the points kept
  std::vector<int> thin_leaves_, thin_codes_;
  std::vector<PointTree::Key> keys_;
};

/// n lists of k neighbours each, which are still to be filled in.
FRESCO_EXPORT NeighborLists evenLists(Index n, Index k);

/// use(i, positions, count) for every point: as nearestLists(), without keeping the lists. In parallel.
/// @param k >= 1
FRESCO_EXPORT void forNearest(const PointTree& tree, int k, int threads,
                              const std::function<void(Index, const int*, Index)>& use);
} // namespace fresco
