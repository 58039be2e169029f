// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/simd.h>
namespace fresco::filters {
namespace {
/// exp(v) for v <= 0, relative error below 2e-7; below -87 exactly 0. 2^n exp(f ln 2) with f in -0.5..0.5 and the Taylor
/// polynomial of degree 7. Eigen's exp has other bits with AVX2, and results must not depend on the processor.
/// @tparam Vector Float4 or Float8
template <typename Vector>
inline Vector exponential(const Vector& v)
{
  using Integers = decltype(v < v);
  const Integers normal = v > -87.f;
  const Vector clamped = normal ? v : Vector{} - 87.f;
  const Vector n = (clamped * 1.44269504f + 12582912.f) - 12582912.f; // 1.5 * 2^23: rounds to an integer
  const Vector r = (clamped - n * 0.693359375f) + n * 2.12194440e-4f; // ln 2 in two parts
  Vector p = Vector{} + 1.f / 5040;
  constexpr float terms[] = {1.f / 720, 1.f / 120, 1.f / 24, 1.f / 6, 0.5f, 1.f, 1.f};
  for (const float term : terms)
    p = p * r + term;
  const Integers power = (__builtin_convertvector(n, Integers) + 127) << 23;
  return normal ? p * reinterpret_cast<Vector>(power) : Vector{};
}

/// Of each value.
inline void exponential(float* values, std::ptrdiff_t count)
{
  for (; count >= 4; count -= 4, values += 4)
    simd::store(exponential(simd::load<simd::Float4>(values)), values);
  simd::Float4 rest = {};
  std::memcpy(&rest, values, count * sizeof(float));
  rest = exponential(rest);
  std::memcpy(values, &rest, count * sizeof(float));
}
} // namespace
} // namespace fresco::filters
