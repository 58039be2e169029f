// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "plan/plane_points.h"
#include "plan/regions.h"
namespace fresco::plan {
struct OpeningInput {
  const PlanePoints& upright;
  const Storey& storey;
  const Regions& regions;
  double cell; ///< metres between samples, about
};

/// Doors and windows of a wall at the height of the cut. @param floor of its room, metres
std::vector<PlanOpening> findOpenings(const PlanWall& wall, double floor, const OpeningInput& input);
} // namespace fresco::plan
