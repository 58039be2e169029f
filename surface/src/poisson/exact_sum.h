// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
namespace fresco::poisson {
/// Sum of up to 2^39 floats without rounding, so that their order does not matter: one whole number per exponent.
class ExactSum {
public:
  /// @param value finite
  void add(float value)
  {
    int exponent = 0;
    const float mantissa = std::frexp(value, &exponent);
    sums_[exponent + lowest] += static_cast<std::int64_t>(std::ldexp(mantissa, mantissa_bits));
  }

  void add(const ExactSum& other)
  {
    for (std::size_t i = 0; i < sums_.size(); ++i)
      sums_[i] += other.sums_[i];
  }

  double value() const
  {
    double sum = 0;
    for (int i = 0; i < static_cast<int>(sums_.size()); ++i)
      sum += std::ldexp(static_cast<double>(sums_[i]), i - lowest - mantissa_bits);
    return sum;
  }

private:
  static constexpr int mantissa_bits = 24;
  static constexpr int lowest = 148;        // of the smallest float, 2^-149 = 0.5 * 2^-148
  std::array<std::int64_t, 277> sums_ = {}; // up to 2^128
};
} // namespace fresco::poisson
