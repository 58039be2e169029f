// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/occupied_cells.h"
namespace fresco::poisson {
/// Sums over the points of each occupied cell, in whole numbers: neither the order of the points nor how they are divided
/// into pieces matters.
class CellSums {
public:
  CellSums(OccupiedCells cells, const Extent& extent, int threads);
  void add(const SortedPoints& points, int threads);

  /// Means of the points of each cell; the sums are given back piece by piece.
  Samples takeSamples(int threads);

private:
  using Whole = std::int64_t;
  /// Weights are multiples of 2^-28: the weights of 2^34 points, 1 on average, fit into 63 bits, and a position is 2^-28
  /// of a cell exact, a thousandth of what float keeps of it.
  struct Sums {
    Whole weight, position[3], normal[3];
  };
  struct AttributeSums {
    Whole color[3], intensity;
  };
  struct CellPoints;

  void addCell(const CellPoints& cell, std::uint32_t number);
  void addAttributes(const PointSet& set, Index i, Whole weight, AttributeSums& sums) const;
  Sample sampleOf(std::uint64_t code, const Sums& sums) const;
  Attributes attributesOf(const AttributeSums& sums, Whole weight) const;

  OccupiedCells cells_;
  Array<std::uint32_t> first_; ///< see OccupiedCells::firstCells()
  Extent extent_;
  double intensity_unit_; ///< power of two, at least the largest intensity
  std::vector<Array<Sums>> sums_;
  std::vector<Array<AttributeSums>> attribute_sums_; ///< empty if the points have neither colour nor intensity
};
} // namespace fresco::poisson
