// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "plan/surfaces.h"
namespace fresco::plan {
/// Square cells over the plan.
struct Grid {
  Eigen::Vector2d low = {0, 0}; ///< corner of the first cell
  double cell = 0.02;           ///< metres
  int width = 0, height = 0;

  Eigen::Vector2d center(double x, double y) const { return low + cell * Eigen::Vector2d(x + 0.5, y + 0.5); }
  /// -1 outside
  Index at(double x, double y) const
  {
    const double column = std::floor((x - low.x()) / cell), row = std::floor((y - low.y()) / cell);
    if (!(column >= 0 && column < width && row >= 0 && row < height))
      return -1;
    return static_cast<Index>(row) * width + static_cast<Index>(column);
  }
};

/// A room as cells.
struct Region {
  Polyline outline;               ///< centres of its outermost cells, counter-clockwise, not closed
  std::vector<Polyline> columns;  ///< the same around what stands in it, clockwise
  Eigen::Vector2d label = {0, 0}; ///< far from all walls
};

struct Regions {
  Grid grid;
  std::vector<int> labels; ///< per cell, index into `regions` or -1
  std::vector<Region> regions;
};

struct RegionInput {
  const LevelSamples& level;
  const std::vector<Eigen::Vector3f>& upright;
  const Storey& storey;
  double cell; ///< metres; 0 = from the density of `upright`
  double door; ///< widest passage between two rooms, metres
};

Regions findRegions(const RegionInput& input);
} // namespace fresco::plan
