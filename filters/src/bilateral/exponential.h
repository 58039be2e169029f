// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <cstring>
#include <fresco/core/types.h>
namespace fresco::filters {
/// values[i] = exp(values[i]) for values <= 0, relative error below 2e-7; below -87 exactly 0. A loop that compilers
/// turn into vector code: 2^n exp(f ln 2) with f in -0.5..0.5 and the Taylor polynomial of degree 7. Eigen's exp has
/// other bits than plane_kernels_avx2.cpp, and results must not depend on the processor.
inline void exponential(float* values, Index count)
{
  for (Index i = 0; i < count; ++i) {
    const float clamped = values[i] > -87.f ? values[i] : -87.f;
    const float shifted = clamped * 1.44269504f + 12582912.f; // 1.5 * 2^23: rounds to an integer in the low bits
    const float n = shifted - 12582912.f;
    const float r = (clamped - n * 0.693359375f) + n * 2.12194440e-4f; // ln 2 in two parts
    float p = 1.f / 5040;
    p = p * r + 1.f / 720;
    p = p * r + 1.f / 120;
    p = p * r + 1.f / 24;
    p = p * r + 1.f / 6;
    p = p * r + 0.5f;
    p = p * r + 1.f;
    p = p * r + 1.f;
    const std::int32_t bits = (static_cast<std::int32_t>(n) + 127) << 23;
    float power;
    std::memcpy(&power, &bits, sizeof power);
    values[i] = values[i] > -87.f ? p * power : 0.f;
  }
}
} // namespace fresco::filters
