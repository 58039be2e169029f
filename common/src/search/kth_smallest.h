// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#ifndef FRESCO_LANE_CODE
#define FRESCO_LANE_CODE // attributes of functions that are compiled for certain processors
#endif
namespace fresco {
namespace {
/// A limit that exactly `k` of `count` values, all below `bound`, are below: by interpolation, as the number of points
/// of a surface grows with the squared distance, and bisection. Negative if not found.
template <typename Counter>
FRESCO_LANE_CODE float findLimit(const Counter& counter, std::size_t count, std::size_t k, float bound)
{
  float low = 0, high = bound;
  auto below_low = 0.f, below_high = static_cast<float>(count);
  const auto wanted = static_cast<float>(k);
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
      below_low = static_cast<float>(below);
    } else {
      high = limit;
      below_high = static_cast<float>(below);
    }
  }
  return -1.f;
}
} // namespace
} // namespace fresco
