// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
/// Factor per view and channel that makes views of the same surface agree: least squares over the median ratio of each
/// pair of views, robust against pairs that disagree with the rest. Means of their logarithms are 0; 1 where nothing is
/// known.
/// @param owner per candidate view what it is a part of: parts of one have the same factor
Points solveGains(const Candidates& candidates, const std::vector<int>& owner);
} // namespace fresco::texture
