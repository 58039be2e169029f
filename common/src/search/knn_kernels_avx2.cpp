// SPDX-License-Identifier: BSD-3-Clause
// Only these functions are compiled for AVX2, and they run only where the processor has it. No header with inline
// functions of external linkage may be used here: the linker could keep their AVX2 code for the whole program.
#include "search/knn_kernels.h"
#if defined(__x86_64__) && defined(__GNUC__)
#define FRESCO_SIMD_TARGET __attribute__((target("avx2,popcnt")))
#include "search/kth_smallest.h"
#include <immintrin.h>
namespace fresco::search {
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

/// Lanes to permute by so that those set come first. The permutation uses the lowest 3 bits of each lane.
FRESCO_SIMD_TARGET inline __m256i packedLanes(unsigned set)
{
  const __m256i shifts = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
  return _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(packing.lanes[set])), shifts);
}

FRESCO_SIMD_TARGET inline unsigned lanesBelow(__m256 values, __m256 limit)
{
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(values, limit, _CMP_LT_OQ)));
}

FRESCO_SIMD_TARGET inline std::size_t bits(unsigned set) { return static_cast<unsigned>(__builtin_popcount(set)); }

FRESCO_SIMD_TARGET inline __m256 squaredLength(__m256 x, __m256 y, __m256 z)
{
  return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y)), _mm256_mul_ps(z, z));
}

FRESCO_SIMD_TARGET inline __m256i positionsOf(__m256i lanes, int leaf)
{
  return _mm256_add_epi32(_mm256_and_si256(lanes, _mm256_set1_epi32(7)), _mm256_set1_epi32(leaf * 8));
}

FRESCO_SIMD_TARGET std::size_t closer(const float* coordinates, const int* leaves, std::size_t leaf_count,
                                      const float* query, float bound, float* squared, int* position)
{
  const __m256 x = _mm256_set1_ps(query[0]), y = _mm256_set1_ps(query[1]), z = _mm256_set1_ps(query[2]);
  const __m256 limit = _mm256_set1_ps(bound);
  std::size_t found = 0;
  for (std::size_t l = 0; l < leaf_count; ++l) {
    const float* leaf = coordinates + static_cast<std::size_t>(leaves[l]) * 24;
    const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(leaf), x), dy = _mm256_sub_ps(_mm256_loadu_ps(leaf + 8), y);
    const __m256 distances = squaredLength(dx, dy, _mm256_sub_ps(_mm256_loadu_ps(leaf + 16), z));
    const unsigned set = lanesBelow(distances, limit);
    if (set == 0)
      continue;
    const __m256i lanes = packedLanes(set);
    _mm256_storeu_ps(squared + found, _mm256_permutevar8x32_ps(distances, lanes));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(position + found), positionsOf(lanes, leaves[l]));
    found += bits(set);
  }
  return found;
}

FRESCO_SIMD_TARGET std::size_t offsets(const float* coordinates, const int* leaves, std::size_t leaf_count,
                                       const float* query, float bound, const KnnPoints& points)
{
  const __m256 x = _mm256_set1_ps(query[0]), y = _mm256_set1_ps(query[1]), z = _mm256_set1_ps(query[2]);
  const __m256 limit = _mm256_set1_ps(bound);
  const KnnPoints to = points;
  std::size_t found = 0;
  for (std::size_t l = 0; l < leaf_count; ++l) {
    const float* leaf = coordinates + static_cast<std::size_t>(leaves[l]) * 24;
    const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(leaf), x), dy = _mm256_sub_ps(_mm256_loadu_ps(leaf + 8), y);
    const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(leaf + 16), z);
    const __m256 distances = squaredLength(dx, dy, dz);
    const unsigned set = lanesBelow(distances, limit);
    if (set == 0)
      continue;
    const __m256i lanes = packedLanes(set);
    _mm256_storeu_ps(to.squared + found, _mm256_permutevar8x32_ps(distances, lanes));
    _mm256_storeu_ps(to.x + found, _mm256_permutevar8x32_ps(dx, lanes));
    _mm256_storeu_ps(to.y + found, _mm256_permutevar8x32_ps(dy, lanes));
    _mm256_storeu_ps(to.z + found, _mm256_permutevar8x32_ps(dz, lanes));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to.position + found), positionsOf(lanes, leaves[l]));
    found += bits(set);
  }
  return found;
}

FRESCO_SIMD_TARGET inline float smallest(__m256 v)
{
  const __m128 four = _mm_min_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
  const __m128 two = _mm_min_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_min_ss(two, _mm_movehdup_ps(two)));
}

FRESCO_SIMD_TARGET inline float largest(__m256 v)
{
  const __m128 four = _mm_max_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
  const __m128 two = _mm_max_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_max_ss(two, _mm_movehdup_ps(two)));
}

FRESCO_SIMD_TARGET void boxes(const float* coordinates, std::size_t leaf_count, std::size_t stride, float* boxes)
{
  for (std::size_t l = 0; l < leaf_count; ++l)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const __m256 values = _mm256_loadu_ps(coordinates + 24 * l + 8 * axis);
      boxes[axis * stride + l] = smallest(values);
      boxes[(3 + axis) * stride + l] = largest(values);
    }
}

FRESCO_SIMD_TARGET std::size_t closeBoxes(const float* boxes, std::size_t leaf_count, std::size_t stride,
                                          std::size_t center, float reach, int* leaves)
{
  const __m256 limit = _mm256_set1_ps(reach * reach);
  const __m256i places = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  std::size_t found = 0;
  for (std::size_t l = 0; l < leaf_count; l += 8) {
    __m256 gaps[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float *low = boxes + axis * stride, *high = low + 3 * stride;
      const __m256 above = _mm256_sub_ps(_mm256_loadu_ps(low + l), _mm256_broadcast_ss(high + center));
      const __m256 below = _mm256_sub_ps(_mm256_broadcast_ss(low + center), _mm256_loadu_ps(high + l));
      gaps[axis] = _mm256_max_ps(_mm256_max_ps(above, below), _mm256_setzero_ps());
    }
    const __m256 close = _mm256_cmp_ps(squaredLength(gaps[0], gaps[1], gaps[2]), limit, _CMP_LE_OQ);
    auto set = static_cast<unsigned>(_mm256_movemask_ps(close));
    if (l + 8 > leaf_count)
      set &= (1u << (leaf_count - l)) - 1;
    const __m256i numbers = _mm256_add_epi32(places, _mm256_set1_epi32(static_cast<int>(l)));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(leaves + found),
                        _mm256_permutevar8x32_epi32(numbers, packedLanes(set)));
    found += bits(set);
  }
  return found;
}

struct Counter {
  const float* values;
  std::size_t count;
  FRESCO_SIMD_TARGET std::size_t below(float limit) const
  {
    const __m256 limits = _mm256_set1_ps(limit);
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; i += 8)
      found += bits(lanesBelow(_mm256_loadu_ps(values + i), limits));
    return found;
  }
};

FRESCO_SIMD_TARGET float limit(float* values, std::size_t count, std::size_t k, float bound)
{
  _mm256_storeu_ps(values + count, _mm256_set1_ps(__builtin_inff()));
  return kthSmallest(Counter{values, count}, count, k, bound);
}

FRESCO_SIMD_TARGET inline float total(__m256 v)
{
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)));
}

FRESCO_SIMD_TARGET void sum(const KnnPoints& points, std::size_t count, float limit, float* sums, int* chosen)
{
  _mm256_storeu_ps(points.squared + count, _mm256_set1_ps(__builtin_inff()));
  const __m256 limits = _mm256_set1_ps(limit), zero = _mm256_setzero_ps();
  __m256 sx = zero, sy = zero, sz = zero, xx = zero, xy = zero, xz = zero, yy = zero, yz = zero, zz = zero, far = zero;
  for (std::size_t i = 0; i < count; i += 8) {
    const __m256 squared = _mm256_loadu_ps(points.squared + i), in = _mm256_cmp_ps(squared, limits, _CMP_LT_OQ);
    const auto set = static_cast<unsigned>(_mm256_movemask_ps(in));
    const __m256i positions = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(points.position + i));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(chosen), _mm256_permutevar8x32_epi32(positions, packedLanes(set)));
    chosen += bits(set);
    const __m256 x = _mm256_and_ps(_mm256_loadu_ps(points.x + i), in);
    const __m256 y = _mm256_and_ps(_mm256_loadu_ps(points.y + i), in);
    const __m256 z = _mm256_and_ps(_mm256_loadu_ps(points.z + i), in);
    sx = _mm256_add_ps(sx, x), sy = _mm256_add_ps(sy, y), sz = _mm256_add_ps(sz, z);
    xx = _mm256_add_ps(xx, _mm256_mul_ps(x, x)), xy = _mm256_add_ps(xy, _mm256_mul_ps(x, y));
    xz = _mm256_add_ps(xz, _mm256_mul_ps(x, z)), yy = _mm256_add_ps(yy, _mm256_mul_ps(y, y));
    yz = _mm256_add_ps(yz, _mm256_mul_ps(y, z)), zz = _mm256_add_ps(zz, _mm256_mul_ps(z, z));
    far = _mm256_max_ps(far, _mm256_and_ps(squared, in));
  }
  const __m256 all[] = {sx, sy, sz, xx, xy, xz, yy, yz, zz};
  for (int t = 0; t < 9; ++t)
    sums[t] = total(all[t]);
  sums[9] = largest(far);
}

FRESCO_SIMD_TARGET void rank(float* values, std::size_t count, int* ranks)
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

const KnnKernels* avx2KnnKernels()
{
  static const KnnKernels kernels = {closer, offsets, boxes, closeBoxes, limit, sum, rank};
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt") ? &kernels : nullptr;
}
} // namespace fresco::search
#else
namespace fresco::search {
const KnnKernels* avx2KnnKernels() { return nullptr; }
} // namespace fresco::search
#endif
