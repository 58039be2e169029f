// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples/cube.h"
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
  /// Of the points begin .. end - 1.
  SortedPoints(const PointSet& set, Index begin, Index end, const Extent& extent, int threads);

  const PointSet& set() const { return set_; }
  Index size() const { return keys_.size(); }
  Index point(Index k) const { return begin_ + Index(keys_[k] & ((std::uint64_t(1) << index_bits_) - 1)); }
  std::uint64_t code(Index k) const { return keys_[k] >> index_bits_; }

private:
  const PointSet& set_;
  Index begin_;
  int index_bits_;
  Array<std::uint64_t> keys_;
};

/// Hands all points of a stream over in sorted pieces.
void forEachPiece(const PointStream& points, const Extent& extent, int threads,
                  const std::function<void(const SortedPoints&)>& receive);

/// Whether that is one piece.
bool isOnePiece(const Extent& extent);
} // namespace fresco::poisson
