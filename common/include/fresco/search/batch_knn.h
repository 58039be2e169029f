// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/search/knn_kernels.h>
#include <fresco/search/neighbors.h>
#include <functional>
namespace fresco {
/// Neighbour search for the points of a subtree at once: the leaves around all of them are found in one descent, those
/// around each leaf among them, and each point is compared with the points in those, eight at a time.
///
/// Points are named by codes: 8 * place of their leaf in leaves() + place in the leaf.
class FRESCO_EXPORT NearGroup {
public:
  explicit NearGroup(const PointTree& tree, const NearKernels& kernels = nearKernels());

  /// Goes to the points of leaves begin .. end - 1.
  void enter(Index begin, Index end);
  Index begin() const { return begin_; } ///< first position
  Index end() const { return end_; }     ///< behind the last position

  /// About the distance of the `k`-th neighbour of a point of the group if they are part of a surface, from their
  /// extent.
  float expectedReach(int k) const;

  /// Finds the leaves within `reach` of the box around the points; none where there are more than `most`.
  void gather(float reach, std::size_t most);
  const std::vector<int>& leaves() const
  {
    return leaves_;
  } ///< ascending, then those of farther neighbours found since
  int position(int code) const { return 8 * leaves_[static_cast<std::size_t>(code) / 8] + code % 8; }

  /// Of any point of the tree; leaves() grows if its leaf is new.
  int codeOf(int position);

  /// Finds the `k` nearest of point i, itself included (equally far ones by position), for what follows.
  /// @param k <= tree.size()
  void nearest(Index i, int k);
  /// Their positions, by distance, then position.
  void ordered(int* positions);
  /// Sums of their offsets from the point (see NearKernels::sum). @return their codes, about in order of position
  const int* sum(float* sums);

  /// Positions of the gathered points that are no farther from point i than `radius`, ascending. @return how many
  std::size_t within(Index i, float radius);
  const std::vector<int>& positions() const { return position_; }

  /// Keeps some of the gathered points, evenly spread, for keptWithin(): such that about `wanted` of those of a surface
  /// are within `radius` of one of them.
  void thin(float radius, int wanted);
  /// Finds the points kept that are no farther from point i than `radius`, for sum(). @return how many
  std::size_t keptWithin(Index i, float radius);

private:
  void prepare();
  void makeRoom(std::size_t leaf_count);
  void focus(Index leaf, float reach);
  bool choose(Index i, int k, float bound);
  void chooseFromTree(Index i, int k);
  void chooseByKeys(Index i);
  NearPoints points() { return {squared_.data(), x_.data(), y_.data(), z_.data(), position_.data()}; }

  const PointTree& tree_;
  const NearKernels& kernels_;
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
