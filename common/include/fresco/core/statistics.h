// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstddef>
#include <iterator>
namespace fresco {
/// Standard deviation of a normal distribution / median of the absolute deviations.
constexpr double mad_to_sigma = 1.4826;

/// Value that `rank` of the others are not larger than; reorders the values.
/// @param rank 0 .. size - 1
template <typename Values>
auto rankedValue(Values&& values, std::ptrdiff_t rank)
{
  const auto at = std::begin(values) + rank;
  std::nth_element(std::begin(values), at, std::end(values));
  return *at;
}

/// Median, of an even number the upper of the two in the middle; reorders the values.
/// @param values at least one
template <typename Values>
auto median(Values&& values)
{
  return rankedValue(values, static_cast<std::ptrdiff_t>(std::size(values) / 2));
}
} // namespace fresco
