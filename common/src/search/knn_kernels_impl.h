// SPDX-License-Identifier: BSD-3-Clause
// The kernels, for the instructions that the including file is compiled for. No header with inline functions of external
// linkage may be used here: the linker could keep their AVX2 code for the whole program.
#pragma once
#include "search/knn_kernels.h"
#include <fresco/core/simd.h>
namespace fresco::search {
namespace {
using namespace simd;

#ifdef __AVX2__
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
inline constexpr Packing packing;

/// Stores the lanes that are set, one behind the other, and anything up to eight. The permutation uses the lowest 3 bits
/// of each lane.
template <typename Vector, typename T>
inline void storePacked(const Vector& vector, unsigned set, T* to)
{
  const __m256i shifts = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
  const __m256i lanes = _mm256_srlv_epi32(_mm256_set1_epi32(packing.lanes[set]), shifts);
  store(_mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(vector), lanes), to);
}
#else
template <typename Vector, typename T>
inline void storePacked(const Vector& vector, unsigned set, T* to)
{
  for (int lane = 0; lane < 8; ++lane) {
    *to = vector[lane];
    to += set >> lane & 1u;
  }
}
#endif

inline int countOf(unsigned set) { return __builtin_popcount(set); }

inline Float8 squaredLength(const Float8& x, const Float8& y, const Float8& z) { return x * x + y * y + z * z; }

template <bool with_offsets>
std::size_t closer(const KnnLeaves& leaves, const float* query, float bound, const KnnPoints& points)
{
  const KnnPoints to = points; // a copy, that no store can change
  std::size_t found = 0;
  for (std::size_t l = 0; l < leaves.count; ++l) {
    const float* leaf = leaves.coordinates + 24 * std::ptrdiff_t{leaves.list[l]};
    const Float8 dx = load<Float8>(leaf) - query[0], dy = load<Float8>(leaf + 8) - query[1];
    const Float8 dz = load<Float8>(leaf + 16) - query[2], distances = squaredLength(dx, dy, dz);
    const unsigned set = lanesOf(distances < bound);
    if (set == 0)
      continue;
    storePacked(distances, set, to.squared + found);
    storePacked(lane_numbers + 8 * leaves.list[l], set, to.position + found);
    if (with_offsets) {
      storePacked(dx, set, to.x + found);
      storePacked(dy, set, to.y + found);
      storePacked(dz, set, to.z + found);
    }
    found += countOf(set);
  }
  return found;
}

inline void boxes(const float* coordinates, const KnnBoxes& boxes)
{
  for (std::size_t l = 0; l < boxes.count; ++l)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Float8 values = load<Float8>(coordinates + 24 * l + 8 * axis);
      boxes.ends[axis * boxes.stride + l] = joined(values, [](const auto& a, const auto& b) { return smaller(a, b); });
      boxes.ends[(3 + axis) * boxes.stride + l] =
          joined(values, [](const auto& a, const auto& b) { return larger(a, b); });
    }
}

inline std::size_t closeBoxes(const KnnBoxes& boxes, std::size_t center, float reach, int* leaves)
{
  std::size_t found = 0;
  for (std::size_t l = 0; l < boxes.count; l += 8) {
    Float8 gaps[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float *low = boxes.ends + axis * boxes.stride, *high = low + 3 * boxes.stride;
      gaps[axis] = larger(larger(load<Float8>(low + l) - high[center], low[center] - load<Float8>(high + l)), Float8{});
    }
    unsigned set = lanesOf(squaredLength(gaps[0], gaps[1], gaps[2]) <= reach * reach);
    if (l + 8 > boxes.count)
      set &= (1u << (boxes.count - l)) - 1;
    storePacked(lane_numbers + int(l), set, leaves + found);
    found += countOf(set);
  }
  return found;
}

/// By interpolation, since on a surface the number of points grows in proportion to the squared distance, and by
/// bisection.
inline float limit(float* values, std::size_t count, std::size_t k, float bound)
{
  store(infinities, values + count);
  if (count == k)
    return bound;
  float low = 0, high = bound, below_low = 0, below_high = count;
  const float wanted = k;
  for (int step = 0; step < 40; ++step) {
    const float share = step % 3 == 2 ? 0.5f : (wanted - below_low) / (below_high - below_low);
    const float between = low + share * (high - low);
    if (!(between > low && between < high))
      return -1.f;
    std::size_t below = 0;
    for (std::size_t i = 0; i < count; i += 8)
      below += countOf(lanesOf(load<Float8>(values + i) < between));
    if (below == k)
      return between;
    (below < k ? low : high) = between;
    (below < k ? below_low : below_high) = below;
  }
  return -1.f;
}

inline void sum(const KnnPoints& points, float limit, float* sums, int* chosen)
{
  store(infinities, points.squared + points.count);
  Float8 all[9] = {}, far = {};
  for (std::size_t i = 0; i < points.count; i += 8) {
    const Float8 squared = load<Float8>(points.squared + i), none = {};
    const Int8 in = squared < limit;
    const unsigned set = lanesOf(in);
    storePacked(load<Int8>(points.position + i), set, chosen);
    chosen += countOf(set);
    const Float8 x = in ? load<Float8>(points.x + i) : none, y = in ? load<Float8>(points.y + i) : none,
                 z = in ? load<Float8>(points.z + i) : none;
    const Float8 terms[9] = {x, y, z, x * x, x * y, x * z, y * y, y * z, z * z};
    for (int t = 0; t < 9; ++t)
      all[t] += terms[t];
    far = larger(far, in ? squared : none);
  }
  for (int t = 0; t < 9; ++t)
    sums[t] = total(all[t]);
  sums[9] = joined(far, [](const auto& a, const auto& b) { return larger(a, b); });
}

inline void rank(float* values, std::size_t count, int* ranks)
{
  store(infinities, values + count);
  for (std::size_t i = 0; i < count; i += 8) {
    const Float8 eight = load<Float8>(values + i);
    Int8 smaller_ones = {};
    for (std::size_t j = 0; j < count; ++j)
      smaller_ones -= values[j] < eight;
    store(smaller_ones, ranks + i);
  }
}

inline constexpr KnnKernels kernels = {closer<false>, closer<true>, boxes, closeBoxes, limit, sum, rank};
} // namespace
} // namespace fresco::search
