// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "near_kernels.h"
#include <fresco/filters/core/neighbors.h>
namespace fresco {
/// Neighbour search for the points of a subtree at once: the leaves around all of them are found in one descent, and
/// each point is compared with the points in them, eight at a time.
class NearGroup {
public:
  explicit NearGroup(const PointTree& tree, const NearKernels& kernels = nearKernels());

  /// Goes to the points of leaves begin .. end - 1.
  void enter(Index begin, Index end);
  Index begin() const { return begin_; } ///< first position
  Index end() const { return end_; }     ///< behind the last position

  /// Finds the leaves within `reach` of the box around the points; none where there are more than `most`.
  void gather(float reach, std::size_t most);

  /// Writes the `k` nearest of point i, itself included, by distance, then position, to `found`.
  /// @param bound no smaller than the squared distance of the k-th; @return that of the k-th
  float nearest(Index i, int k, float bound, int* found);

  /// Keeps every `step`-th of the gathered points for within(), which spreads them evenly.
  void thin(std::size_t step);

  /// How many points that were gathered and kept are no farther from point i than `radius`; positions() are theirs.
  std::size_t within(Index i, float radius);
  const std::vector<int>& positions() const { return positions_; }

private:
  std::size_t closer(const Eigen::Vector3f& query, float squared_limit);

  const PointTree& tree_;
  const NearKernels& kernels_;
  Index begin_ = 0, end_ = 0;
  Eigen::Vector3f low_, high_;
  float reach_ = 0;
  std::vector<int> leaves_, positions_, ranks_;
  std::vector<float> squared_;
  std::vector<float> thin_coordinates_; ///< as those of the tree; empty: all points are kept
  std::vector<int> thin_leaves_, thin_positions_;
  std::vector<PointTree::Key> keys_;
};
} // namespace fresco
