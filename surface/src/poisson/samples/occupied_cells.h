// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples/sorted_points.h"
#include <utility>
namespace fresco::poisson {
/// A brick of 4^3 finest cells with those of them that hold points, a bit each in Morton order.
struct OccupiedBrick {
  std::uint64_t code, cells;
};

/// The finest cells that hold points: two bytes each where points are dense.
class OccupiedCells {
public:
  OccupiedCells() = default;
  explicit OccupiedCells(Array<OccupiedBrick> bricks) : bricks_(std::move(bricks)) {}

  void add(const SortedPoints& points, int threads);

  const Array<OccupiedBrick>& bricks() const { return bricks_; } ///< codes strictly rising
  Index count() const;                                           ///< cells
  Array<std::uint64_t> codes(int threads) const;                 ///< Morton codes of the cells, strictly rising

  /// Number of the first cell of each brick, and their count at the end.
  /// @throws std::invalid_argument if they are more than 2^32 - 1
  Array<std::uint32_t> firstCells() const;

private:
  Array<OccupiedBrick> bricks_;
};

OccupiedCells findCells(const PointStream& points, const Extent& extent, int threads);

/// Bricks of either list; the cells of both where both have one.
Array<OccupiedBrick> unite(const Array<OccupiedBrick>& a, const Array<OccupiedBrick>& b, int threads);
} // namespace fresco::poisson
