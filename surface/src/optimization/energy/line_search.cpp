// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/energy/line_search.h"
#include <algorithm>
#include <cmath>
namespace fresco::optimization {
namespace {
// Least point of the cubic through two points and their slopes (Nocedal, Wright eq. 3.59), kept off the ends.
double cubicStep(const LinePoint& a, const LinePoint& b)
{
  const double width = b.step - a.step;
  const double d1 = a.slope + b.slope - 3.0 * (a.value - b.value) / (a.step - b.step);
  const double radicand = d1 * d1 - a.slope * b.slope;
  double step = 0.5 * (a.step + b.step);
  if (radicand >= 0.0) {
    const double d2 = std::copysign(std::sqrt(radicand), width);
    const double denominator = b.slope - a.slope + 2.0 * d2;
    if (denominator != 0.0)
      step = b.step - width * (b.slope + d2 - d1) / denominator;
  }
  const double low = std::min(a.step, b.step), high = std::max(a.step, b.step), margin = 0.1 * (high - low);
  return std::isfinite(step) ? std::clamp(step, low + margin, high - margin) : 0.5 * (low + high);
}

class Search {
public:
  Search(const LinePoint& start, const std::function<LinePoint(double)>& at, const LineSearchOptions& options)
      : start_(start), at_(at), options_(options), left_(options.evaluations)
  {}

  LinePoint run(double step)
  {
    constexpr double growth = 3.0; // of the step while the value still falls: 12 evaluations span five decades
    LinePoint last = start_;
    while (left_ > 0) {
      const LinePoint now = probe(step);
      if (!decreases(now) || now.value >= last.value)
        return zoom(last, now);
      if (isFlat(now))
        return now;
      if (now.slope >= 0.0)
        return zoom(now, last);
      last = now;
      step *= growth;
    }
    return last;
  }

private:
  LinePoint probe(double step)
  {
    --left_;
    return at_(step);
  }
  bool decreases(const LinePoint& p) const
  {
    return p.value <= start_.value + options_.decrease * p.step * start_.slope;
  }
  bool isFlat(const LinePoint& p) const { return std::abs(p.slope) <= -options_.curvature * start_.slope; }

  // `low` is the best point so far that decreases; the interval between the two holds one that satisfies both.
  LinePoint zoom(LinePoint low, LinePoint high)
  {
    while (left_ > 0) {
      const LinePoint now = probe(cubicStep(low, high));
      if (!decreases(now) || now.value >= low.value) {
        high = now;
        continue;
      }
      if (isFlat(now))
        return now;
      if (now.slope * (high.step - low.step) >= 0.0)
        high = low;
      low = now;
    }
    return low;
  }

  const LinePoint start_;
  const std::function<LinePoint(double)>& at_;
  const LineSearchOptions options_;
  int left_;
};
} // namespace

LinePoint lineSearch(const LinePoint& start, double first, const std::function<LinePoint(double)>& at,
                     const LineSearchOptions& options)
{
  return Search(start, at, options).run(first);
}
} // namespace fresco::optimization
