// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/cube.h"
#include <functional>
namespace fresco::poisson {
/// Position in finest cells, from the cube's corner.
inline Eigen::Vector3d toCells(const PointSet& set, Index i, const Extent& extent)
{
  return (set.points.col(i).cast<double>() - extent.cube.corner) * extent.cells_per_unit;
}

/// Usable points of a piece of a stream in the order of their finest cells along the Z-order curve. The code of the cell
/// and the number of the point share 64 bits.
class SortedPoints {
public:
  using Keys = Array<std::uint64_t>;

  /// @param begin number of the first point of the piece
  SortedPoints(const PointSet& set, Index begin, int depth, const Keys& keys);

  const PointSet& set() const { return set_; }
  Index size() const { return keys_.size(); }
  Index point(Index k) const { return begin_ + Index(keys_[k] & ((std::uint64_t(1) << index_bits_) - 1)); }
  std::uint64_t code(Index k) const { return keys_[k] >> index_bits_; }

private:
  const PointSet& set_;
  Index begin_;
  int index_bits_;
  const Keys& keys_;
};

/// A stream whose points come in sorted pieces.
class SortedStream {
public:
  SortedStream(const PointStream& points, const Extent& extent, int threads)
      : points_(points), extent_(extent), threads_(threads)
  {}

  const Extent& extent() const { return extent_; }
  void forEachPiece(const std::function<void(const SortedPoints&)>& receive);

private:
  SortedPoints::Keys sortedKeys(const PointSet& set, Index begin, Index end) const;
  const PointStream& points_;
  const Extent& extent_;
  int threads_;
  SortedPoints::Keys only_; ///< of the only piece, once it has been sorted
};
} // namespace fresco::poisson
