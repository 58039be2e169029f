// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/filters/core/mixed_pixels.h>
#include <fresco/search/neighbors.h>
#include <memory>
#include <vector>
namespace fresco::filters {
constexpr int beside = 8;        ///< nearest beams: those around one in a grid
constexpr int nearby_beams = 12; ///< and four more, for beams in no order
constexpr int most_beams = 64;   ///< four rings of a grid, nearly

/// Deviation of the ranges of a scan, by range.
struct RangeNoise {
  std::vector<float> ranges, deviations; ///< ascending lengths, and lengths > 0: at least one

  /// Between those of the ranges beside it, beyond them as at the last.
  float at(float range) const;
};

/// What one viewpoint sees, in the order of a tree over directions.
struct BeamScan {
  std::vector<Index> columns; ///< of the input
  Points directions;          ///< unit
  Eigen::VectorXf ranges;
  NeighborLists lists;             ///< nearest beams by angle, the beam itself included
  std::unique_ptr<PointTree> tree; ///< of all directions
  bool thinned = false;            ///< lists leave out some between
  RangeNoise noise;
};

/// The points of `columns`, seen from one viewpoint, without noise yet.
BeamScan makeBeamScan(const Points& points, const Eigen::Vector3f& viewpoint, const std::vector<Index>& columns,
                      const MixedPixelOptions& options);
} // namespace fresco::filters
