// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
/// Factor per view and channel that makes views of the same surface agree: least squares over the median ratio of each
/// pair of views, robust against pairs that disagree with the rest. Means of their logarithms are 0; 1 where nothing is
/// known.
Points solveGains(const Candidates& candidates, Index views);
} // namespace fresco::texture
