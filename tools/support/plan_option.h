// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "support/args.h"
#include <fresco/deliverables/core/plan.h>
namespace fresco {
/// How a plan is drawn, of tools that find rooms.
inline void declarePlan(Args& args, PlanOptions& o)
{
  args.numbers("height", "H", Range::any(),
               "of the cut, z of the model, metres; default: 1.5 above the lowest large floor",
               [&o](const auto& given) { o.height = given[0]; });
  args.option("tolerance", o.tolerance, Range::above(0).atMost(0.1),
              "metres that data may lie off a straight wall, and that a wall may move to follow a main direction");
  args.option("cell", o.cell, Range::within(0.005, 0.2).zero("from the density of the data"),
              "of the grid that rooms are found in, metres");
  args.option("door", o.door, Range::within(0.3, 5),
              "widest passage that ends a room where nothing hangs from the ceiling, metres");
  args.numbers("up", "X Y Z", Range::any(),
               "upright direction, corrected by the largest floor or ceiling; default: 0 0 1",
               [&o](const auto& given) { o.up = Eigen::Vector3d(given.data()); });
}
} // namespace fresco
