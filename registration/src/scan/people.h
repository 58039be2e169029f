// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/floor_plan.h"
namespace fresco::registration {
/// Finds what may be people, who stand elsewhere when the next scan is made: at the height of chests and heads, what hangs
/// together without the walls, as tall and as slim as a person by the height of the scanner, and what is below.
/// @return per point of check_level, whether it is of one
std::vector<char> findPeople(const PreparedScan& scan, const PlanFrame& frame);
} // namespace fresco::registration
