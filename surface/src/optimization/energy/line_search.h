// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
namespace fresco::optimization {
struct LinePoint {
  double step = 0, value = 0, slope = 0;
};

struct LineSearchOptions {
  double decrease = 1e-4; ///< Armijo: value falls by at least this share of what the slope at 0 promises
  double curvature = 0.1; ///< |slope| falls to at most this share of that at 0
  int evaluations = 12;
};

/// A step along a line that satisfies the strong Wolfe conditions (Nocedal, Wright 2006, "Numerical Optimization",
/// algorithms 3.5 and 3.6), or, where the evaluations do not suffice, the best step that satisfies the first of them.
/// @param start slope below 0
/// @param first step tried first, > 0
/// @param at    value and slope at a step
/// @return step 0 if none lowers the value
LinePoint lineSearch(const LinePoint& start, double first, const std::function<LinePoint(double)>& at,
                     const LineSearchOptions& options = {});
} // namespace fresco::optimization
