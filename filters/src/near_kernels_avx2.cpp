// SPDX-License-Identifier: BSD-3-Clause
// Only these functions are compiled for AVX2, and they run only where the processor has it. No header with inline
// functions of C++ may be used here: the linker could keep their AVX2 code for the whole program.
#include "near_kernels.h"
#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
namespace fresco {
namespace {
/// For each set of lanes (as bits) the lanes that are set, first ones first, 4 bits each.
struct Packing {
  unsigned lanes[256];
  constexpr Packing() : lanes()
  {
    for (unsigned set = 0; set < 256; ++set) {
      unsigned packed = 0, count = 0;
      for (unsigned lane = 0; lane < 8; ++lane)
        if (set >> lane & 1u)
          packed |= lane << (4 * count++);
      lanes[set] = packed;
    }
  }
};
constexpr Packing packing;

__attribute__((target("avx2,popcnt"))) std::size_t closer(const float* coordinates, const int* leaves,
                                                          std::size_t leaf_count, const float* query, float bound,
                                                          float* squared, int* position)
{
  const __m256 x = _mm256_set1_ps(query[0]), y = _mm256_set1_ps(query[1]), z = _mm256_set1_ps(query[2]);
  const __m256 limit = _mm256_set1_ps(bound);
  const __m256i shifts = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
  std::size_t found = 0;
  for (std::size_t l = 0; l < leaf_count; ++l) {
    const float* leaf = coordinates + static_cast<std::size_t>(leaves[l]) * 24;
    const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(leaf), x), dy = _mm256_sub_ps(_mm256_loadu_ps(leaf + 8), y);
    const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(leaf + 16), z);
    const __m256 distances =
        _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
    const auto set = static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(distances, limit, _CMP_LT_OQ)));
    if (set == 0)
      continue;
    // The permutation uses the lowest 3 bits of each lane.
    const __m256i lanes = _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(packing.lanes[set])), shifts);
    const __m256i low = _mm256_and_si256(lanes, _mm256_set1_epi32(7));
    _mm256_storeu_ps(squared + found, _mm256_permutevar8x32_ps(distances, lanes));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(position + found),
                        _mm256_add_epi32(low, _mm256_set1_epi32(leaves[l] * 8)));
    found += static_cast<unsigned>(__builtin_popcount(set));
  }
  return found;
}

__attribute__((target("avx2,popcnt"))) void rank(float* values, std::size_t count, int* ranks)
{
  const __m256 infinity = _mm256_set1_ps(__builtin_inff());
  _mm256_storeu_ps(values + count, infinity);
  const std::size_t rounded = (count + 7) / 8 * 8;
  for (std::size_t i = 0; i < rounded; i += 16) {
    const bool two = i + 8 < rounded;
    const __m256 a = _mm256_loadu_ps(values + i), b = two ? _mm256_loadu_ps(values + i + 8) : infinity;
    __m256i rank_a = _mm256_setzero_si256(), rank_b = rank_a;
    for (std::size_t j = 0; j < count; ++j) {
      const __m256 other = _mm256_broadcast_ss(values + j);
      rank_a = _mm256_sub_epi32(rank_a, _mm256_castps_si256(_mm256_cmp_ps(other, a, _CMP_LT_OQ)));
      rank_b = _mm256_sub_epi32(rank_b, _mm256_castps_si256(_mm256_cmp_ps(other, b, _CMP_LT_OQ)));
    }
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(ranks + i), rank_a);
    if (two)
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(ranks + i + 8), rank_b);
  }
}
} // namespace

const NearKernels* avx2NearKernels()
{
  static const NearKernels kernels = {closer, rank};
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt") ? &kernels : nullptr;
}
} // namespace fresco
#else
namespace fresco {
const NearKernels* avx2NearKernels() { return nullptr; }
} // namespace fresco
#endif
