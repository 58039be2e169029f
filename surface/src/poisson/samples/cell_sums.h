// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples/occupied_cells.h"
namespace fresco::poisson {
/// Sums over the points of a cell, in whole numbers. Weights are multiples of 2^-28: those of 2^34 points, 1 on average,
/// fit into 63 bits. A position is 2^-28 of a cell exact, a thousandth of what float keeps of it.
struct CellSum {
  using Whole = std::int64_t;
  Whole weight, position[3], normal[3];
};

struct AttributeSum {
  CellSum::Whole color[3], intensity;
};

/// How points are added up and what their mean is.
class PointSums {
public:
  explicit PointSums(const Extent& extent);

  /// Adds the points begin .. end - 1, which lie in one cell.
  void add(const SortedPoints& points, Index begin, Index end, CellSum& sum) const;
  void addAttributes(const SortedPoints& points, Index begin, Index end, AttributeSum& sum) const;
  Sample sampleOf(std::uint64_t code, const CellSum& sum) const;
  Attributes attributesOf(const AttributeSum& sum, CellSum::Whole weight) const;

  bool hasAttributes() const { return extent_.colors || extent_.intensities; }
  /// Without samples yet.
  Samples emptySamples(Array<std::uint64_t> codes) const;

private:
  CellSum::Whole weightOf(const PointSet& set, Index i) const;
  Extent extent_;
  double intensity_unit_; ///< power of two, at least the largest intensity
};

/// First point of each cell, and their count at the end.
Array<std::uint32_t> cellBegins(const SortedPoints& points, int threads);

/// Samples of points that are one piece.
Samples samplesOf(const SortedPoints& points, const Extent& extent, int threads);

/// Sums of each occupied cell: neither the order of the points nor how they are divided into pieces matters.
class CellSums {
public:
  CellSums(OccupiedCells cells, const Extent& extent, int threads);
  void add(const SortedPoints& points, int threads);
  /// Adds what another rank has added up.
  void add(std::uint64_t code, const CellSum& sum, const AttributeSum& attributes);

  /// Means of the points of each cell; the sums are given back piece by piece.
  Samples takeSamples(int threads);

private:
  OccupiedCells cells_;
  Array<std::uint32_t> first_; ///< see OccupiedCells::firstCells()
  PointSums points_;
  std::vector<Array<CellSum>> sums_;
  std::vector<Array<AttributeSum>> attribute_sums_; ///< empty if the points have neither colour nor intensity
};
} // namespace fresco::poisson
