// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "support/args.h"
#include <fresco/deliverables/core/plan.h>
namespace fresco {
/// How a plan is drawn, of tools that find rooms.
inline void declarePlan(Args& args, PlanOptions& o)
{
  args.values("height", "H", "of the cut, z of the model, metres (default: 1.5 m above the lowest large floor)",
              [&o](const auto& words) { o.height = Args::number("height", words[0]); });
  args.option("tolerance", o.tolerance,
              "metres that data may lie off a straight wall, and that a wall may move to follow a main direction, "
              "above 0 and at most 0.1");
  args.option("cell", o.cell,
              "of the grid that rooms are found in, metres, 0.005..0.2; 0 = from the density of the data");
  args.option("door", o.door, "widest passage that ends a room where nothing hangs from the ceiling, metres, 0.3..5");
  args.values("up", "X Y Z", "upright direction (default: 0 0 1); it is corrected by the largest floor or ceiling",
              [&o](const auto& words) {
                for (int k = 0; k < 3; ++k)
                  o.up[k] = Args::number("up", words[k]);
              });
}
} // namespace fresco
