// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#ifndef FRESCO_SIMD_TARGET
#define FRESCO_SIMD_TARGET // attributes of functions that are compiled for certain processors
#endif
namespace fresco::search {
namespace {
/// A threshold that separates the `k` smallest of `count` values from the others: exactly `k` are below it. All values
/// are in 0 .. `bound`. Found by interpolation, since on a surface the number of points grows in proportion to the
/// squared distance, and by bisection. Negative where there is no such threshold, as two values are equal, or where 40
/// steps do not find it.
template <typename Counter>
FRESCO_SIMD_TARGET float kthSmallest(const Counter& counter, std::size_t count, std::size_t k, float bound)
{
  float low = 0, high = bound, below_low = 0, below_high = count;
  const float wanted = k;
  if (count == k)
    return bound;
  for (int step = 0; step < 40; ++step) {
    const float share = step % 3 == 2 ? 0.5f : (wanted - below_low) / (below_high - below_low);
    const float limit = low + share * (high - low);
    if (!(limit > low && limit < high))
      return -1.f;
    const std::size_t below = counter.below(limit);
    if (below == k)
      return limit;
    if (below < k) {
      low = limit;
      below_low = below;
    } else {
      high = limit;
      below_high = below;
    }
  }
  return -1.f;
}
} // namespace
} // namespace fresco::search
