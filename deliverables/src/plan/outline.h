// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "plan/plane_points.h"
#include <fresco/deliverables/core/plan.h>
namespace fresco::plan {
/// A straight piece of an outline with the line that its samples lie on. The room is on the left.
struct OutlineEdge {
  Eigen::Vector2d from, to;             ///< corners of the simplified contour
  Eigen::Vector2d point, direction;     ///< the line; unit direction
  bool seen = false;                    ///< samples lie along it
  double rms = 0, ninth = 0, worst = 0; ///< deviation of the samples: root mean square, 90 %, 95 %; metres

  double length() const { return (to - from).norm(); }
};

struct OutlineOptions {
  double cell = 0.02, tolerance = 0.01; ///< metres
  double wall = 0.2;                    ///< metres: thickness that a gap in the data may show of a wall
};

/// Pieces of a closed contour, each with a line fitted to the samples beside it.
/// @param contour centres of the outermost cells, not closed
std::vector<OutlineEdge> fitEdges(const Polyline& contour, const PlanePoints& samples, const OutlineOptions& options);

/// Directions modulo 90 degrees that edges share within the tolerance, those of the most length first; degrees, 0..90.
std::vector<double> mainDirections(const std::vector<OutlineEdge>& edges, double tolerance);

/// Turns edges to main directions where that moves no end by more than the tolerance, joins those on one line, continues
/// walls through gaps in the data and ends them where their lines meet.
/// @return closed chain of walls
std::vector<PlanWall> joinEdges(std::vector<OutlineEdge> edges, const std::vector<double>& directions,
                                const PlanePoints& samples, const OutlineOptions& options);
} // namespace fresco::plan
