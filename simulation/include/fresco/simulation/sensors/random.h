// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <cstdint>
#include <fresco/core/constants.h>
namespace fresco::simulation {
/// Finaliser of SplitMix64 (Steele, Lea, Flood 2014): a bijection of 64 bits that looks random.
inline std::uint64_t scramble(std::uint64_t x)
{
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Random numbers that are a function of (seed, stream, counter) alone: one generator per ray or pixel, so that results
/// do not depend on the order in which rays are traced.
class CounterRandom {
public:
  CounterRandom(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter)
      : state_(scramble(seed + step_ * scramble(stream + step_ * scramble(counter + step_))))
  {}

  /// 0 <= value < 1
  double uniform()
  {
    state_ += step_;
    return (scramble(state_) >> 11) * 0x1.0p-53;
  }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  float uniformFloat() { return uniform(); }
  float uniformFloat(double low, double high) { return uniform(low, high); }
  int integer(int count) { return static_cast<int>(uniform() * count); } ///< 0 .. count - 1

  /// Mean 0, deviation 1 (Box, Muller 1958).
  double gaussian()
  {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2 * pi * uniform());
  }

private:
  static constexpr std::uint64_t step_ = 0x9e3779b97f4a7c15ull;
  std::uint64_t state_;
};
} // namespace fresco::simulation
