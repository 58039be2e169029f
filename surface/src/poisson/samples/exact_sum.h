// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/select.h"
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <fresco/core/exchange.h>
#include <fresco/core/parallel.h>
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

  /// @param value finite, its parts no smaller than the smallest float
  void add(double value)
  {
    for (int part = 0; part < 3 && value != 0; ++part) { // three mantissas of float hold that of a double
      const auto rounded = static_cast<float>(value);
      add(rounded);
      value -= rounded;
    }
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

  /// Over all ranks.
  void share(Exchange& exchange) { exchange.sum(sums_.data(), sums_.size()); }

private:
  static constexpr int mantissa_bits = 24;
  static constexpr int lowest = 148;        // of the smallest float, 2^-149 = 0.5 * 2^-148
  std::array<std::int64_t, 277> sums_ = {}; // up to 2^128
};

/// f(0) + .. + f(n - 1), and that of all ranks: the same bits whatever the order. @param f gives two numbers
template <typename Function>
Eigen::Array2d exactSums(Exchange& exchange, Index n, int threads, const Function& f)
{
  using Sums = std::array<ExactSum, 2>;
  const auto map = [&](Index begin, Index end) {
    Sums sums;
    for (Index i = begin; i < end; ++i) {
      const Eigen::Array2d values = f(i);
      sums[0].add(values[0]);
      sums[1].add(values[1]);
    }
    return sums;
  };
  const auto join = [](Sums a, const Sums& b) {
    a[0].add(b[0]);
    a[1].add(b[1]);
    return a;
  };
  Sums sums = parallelReduce(n, threads, Sums(), map, join, chunk_size);
  sums[0].share(exchange);
  sums[1].share(exchange);
  return {sums[0].value(), sums[1].value()};
}
} // namespace fresco::poisson
