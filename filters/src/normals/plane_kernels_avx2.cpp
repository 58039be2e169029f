// SPDX-License-Identifier: BSD-3-Clause
// Only these functions are compiled for AVX2, and they run only where the processor has it. No header with inline
// functions of external linkage may be used here: the linker could keep their AVX2 code for the whole program.
#include "normals/plane_kernels.h"
#if defined(__x86_64__) && defined(__GNUC__)
#define FRESCO_SIMD_TARGET __attribute__((target("avx2")))
#include <immintrin.h>
namespace fresco::filters {
namespace {
/// Four numbers in double precision.
struct Four {
  __m256d v;
  FRESCO_SIMD_TARGET Four() : v(_mm256_setzero_pd()) {}
  FRESCO_SIMD_TARGET Four(__m256d values) : v(values) {}
  FRESCO_SIMD_TARGET explicit Four(double value) : v(_mm256_set1_pd(value)) {}
};
FRESCO_SIMD_TARGET inline Four operator+(const Four& a, const Four& b) { return _mm256_add_pd(a.v, b.v); }
FRESCO_SIMD_TARGET inline Four operator-(const Four& a, const Four& b) { return _mm256_sub_pd(a.v, b.v); }
FRESCO_SIMD_TARGET inline Four operator*(const Four& a, const Four& b) { return _mm256_mul_pd(a.v, b.v); }
FRESCO_SIMD_TARGET inline Four operator/(const Four& a, const Four& b) { return _mm256_div_pd(a.v, b.v); }
FRESCO_SIMD_TARGET inline Four squareRoot(const Four& a) { return _mm256_sqrt_pd(a.v); }
FRESCO_SIMD_TARGET inline Four least(const Four& a, const Four& b) { return _mm256_min_pd(a.v, b.v); }
FRESCO_SIMD_TARGET inline Four most(const Four& a, const Four& b) { return _mm256_max_pd(a.v, b.v); }
FRESCO_SIMD_TARGET inline Four ifLess(const Four& a, const Four& b, const Four& yes, const Four& no)
{
  return _mm256_blendv_pd(no.v, yes.v, _mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ));
}
} // namespace
} // namespace fresco::filters
#include "normals/plane_fit_simd.h"
namespace fresco::filters {
namespace {
FRESCO_SIMD_TARGET inline Four load(const float* values) { return _mm256_cvtps_pd(_mm_loadu_ps(values)); }
FRESCO_SIMD_TARGET inline void store(float* values, const Four& four)
{
  _mm_storeu_ps(values, _mm256_cvtpd_ps(four.v));
}

FRESCO_SIMD_TARGET void fit(const EightMoments& moments, EightPlanes& planes)
{
  planes.planes = 0;
  const __m256d infinity = _mm256_set1_pd(__builtin_inf());
  for (unsigned half = 0; half < 8; half += 4) {
    Four sums[9];
    for (int s = 0; s < 9; ++s)
      sums[s] = load(moments.sums[s] + half);
    const auto lanes = fitPlanes<Four>(load(moments.weight + half), sums);
    for (int axis = 0; axis < 3; ++axis) {
      store(planes.normal[axis] + half, lanes.normal[axis]);
      store(planes.center[axis] + half, lanes.center[axis]);
    }
    store(planes.variance + half, lanes.variance);
    store(planes.curvature + half, lanes.curvature);
    const __m256d wide = _mm256_cmp_pd(lanes.second.v, _mm256_set1_pd(rounding_share), _CMP_GT_OQ);
    const __m256d some = _mm256_cmp_pd(lanes.trace.v, _mm256_setzero_pd(), _CMP_GT_OQ);
    const __m256d finite = _mm256_cmp_pd(lanes.trace.v, infinity, _CMP_LT_OQ);
    const __m256d told = _mm256_cmp_pd(lanes.squared.v, _mm256_setzero_pd(), _CMP_GT_OQ);
    const int set = _mm256_movemask_pd(_mm256_and_pd(_mm256_and_pd(wide, told), _mm256_and_pd(some, finite)));
    planes.planes |= static_cast<unsigned>(set) << half;
  }
}

/// Rows to columns.
FRESCO_SIMD_TARGET inline void transpose(const __m256 (&row)[8], __m256 (&column)[8])
{
  __m256 pairs[8], fours[8];
  for (int i = 0; i < 8; i += 2) {
    pairs[i] = _mm256_unpacklo_ps(row[i], row[i + 1]);
    pairs[i + 1] = _mm256_unpackhi_ps(row[i], row[i + 1]);
  }
  for (int i = 0; i < 8; i += 4) {
    fours[i] = _mm256_shuffle_ps(pairs[i], pairs[i + 2], 0x44);
    fours[i + 1] = _mm256_shuffle_ps(pairs[i], pairs[i + 2], 0xee);
    fours[i + 2] = _mm256_shuffle_ps(pairs[i + 1], pairs[i + 3], 0x44);
    fours[i + 3] = _mm256_shuffle_ps(pairs[i + 1], pairs[i + 3], 0xee);
  }
  for (int i = 0; i < 4; ++i) {
    column[i] = _mm256_permute2f128_ps(fours[i], fours[i + 4], 0x20);
    column[i + 4] = _mm256_permute2f128_ps(fours[i], fours[i + 4], 0x31);
  }
}

FRESCO_SIMD_TARGET inline __m256 dot(__m256 ax, __m256 bx, __m256 ay, __m256 by, __m256 az, __m256 bz)
{
  return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(ax, bx), _mm256_mul_ps(ay, by)), _mm256_mul_ps(az, bz));
}

FRESCO_SIMD_TARGET BestPlane best(const float* planes, const std::uint16_t* list, std::size_t count, const float* own,
                                  const float* point)
{
  const __m256 px = _mm256_broadcast_ss(point), py = _mm256_broadcast_ss(point + 1);
  const __m256 pz = _mm256_broadcast_ss(point + 2), half = _mm256_set1_ps(0.5f), sign = _mm256_set1_ps(-0.f);
  const __m256 nx = _mm256_broadcast_ss(own), ny = _mm256_broadcast_ss(own + 1), nz = _mm256_broadcast_ss(own + 2);
  __m256 scores = _mm256_set1_ps(__builtin_inff()), cosines = _mm256_set1_ps(1.f);
  __m256i which = _mm256_setzero_si256(), place = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  for (std::size_t j = 0; j < count; j += 8) {
    __m256 row[8], p[8];
    for (std::size_t i = 0; i < 8; ++i) // the last one again for those that are missing
      row[i] = _mm256_loadu_ps(planes + 8 * static_cast<std::size_t>(list[j + i < count ? j + i : count - 1]));
    transpose(row, p);
    const __m256 cosine = _mm256_andnot_ps(sign, dot(p[0], nx, p[1], ny, p[2], nz));
    const __m256 dx = _mm256_sub_ps(px, p[4]), dy = _mm256_sub_ps(py, p[5]), dz = _mm256_sub_ps(pz, p[6]);
    const __m256 distance = dot(p[0], dx, p[1], dy, p[2], dz);
    const __m256 score = _mm256_add_ps(p[3], _mm256_mul_ps(half, _mm256_mul_ps(distance, distance)));
    const __m256 better = _mm256_cmp_ps(score, scores, _CMP_LT_OQ);
    scores = _mm256_blendv_ps(scores, score, better);
    which = _mm256_blendv_epi8(which, place, _mm256_castps_si256(better));
    cosines = _mm256_min_ps(cosine, cosines);
    place = _mm256_add_epi32(place, _mm256_set1_epi32(8));
  }
  float score[8], cosine[8];
  int places[8];
  _mm256_storeu_ps(score, scores);
  _mm256_storeu_ps(cosine, cosines);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(places), which);
  BestPlane result = {score[0], cosine[0], places[0]};
  for (int i = 1; i < 8; ++i) {
    result.closest = cosine[i] < result.closest ? cosine[i] : result.closest;
    if (score[i] < result.score || (score[i] == result.score && places[i] < result.which)) {
      result.score = score[i];
      result.which = places[i];
    }
  }
  return result;
}

/// As exponential().
FRESCO_SIMD_TARGET inline __m256 exponential(__m256 values)
{
  const __m256 lowest = _mm256_set1_ps(-87.f), round = _mm256_set1_ps(12582912.f);
  const __m256 normal = _mm256_cmp_ps(values, lowest, _CMP_GT_OQ), clamped = _mm256_blendv_ps(lowest, values, normal);
  const __m256 shifted = _mm256_add_ps(_mm256_mul_ps(clamped, _mm256_set1_ps(1.44269504f)), round);
  const __m256 n = _mm256_sub_ps(shifted, round);
  const __m256 coarse = _mm256_sub_ps(clamped, _mm256_mul_ps(n, _mm256_set1_ps(0.693359375f)));
  const __m256 r = _mm256_add_ps(coarse, _mm256_mul_ps(n, _mm256_set1_ps(2.12194440e-4f)));
  __m256 p = _mm256_set1_ps(1.f / 5040);
  constexpr float terms[] = {1.f / 720, 1.f / 120, 1.f / 24, 1.f / 6, 0.5f, 1.f, 1.f};
  for (const float term : terms)
    p = _mm256_add_ps(_mm256_mul_ps(p, r), _mm256_set1_ps(term));
  const __m256i bits = _mm256_slli_epi32(_mm256_add_epi32(_mm256_cvttps_epi32(n), _mm256_set1_epi32(127)), 23);
  return _mm256_and_ps(_mm256_mul_ps(p, _mm256_castsi256_ps(bits)), normal);
}

FRESCO_SIMD_TARGET inline float total(__m256 v)
{
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)));
}

FRESCO_SIMD_TARGET void weightedSums(const WeightedPoints& points, const float* plane, float scale, float* sums)
{
  const __m256 a = _mm256_broadcast_ss(plane), b = _mm256_broadcast_ss(plane + 1), c = _mm256_broadcast_ss(plane + 2);
  const __m256 height = _mm256_broadcast_ss(plane + 3), factor = _mm256_set1_ps(scale);
  __m256 all[10];
  for (__m256& one : all)
    one = _mm256_setzero_ps();
  __m256i place = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i count = _mm256_set1_epi32(static_cast<int>(points.count));
  for (std::size_t i = 0; i < points.count; i += 8) {
    const __m256 in = _mm256_castsi256_ps(_mm256_cmpgt_epi32(count, place));
    const __m256 x = _mm256_and_ps(_mm256_loadu_ps(points.x + i), in);
    const __m256 y = _mm256_and_ps(_mm256_loadu_ps(points.y + i), in);
    const __m256 z = _mm256_and_ps(_mm256_loadu_ps(points.z + i), in);
    const __m256 distance = _mm256_sub_ps(dot(x, a, y, b, z, c), height);
    const __m256 w = _mm256_and_ps(exponential(_mm256_mul_ps(factor, _mm256_mul_ps(distance, distance))), in);
    const __m256 wx = _mm256_mul_ps(w, x), wy = _mm256_mul_ps(w, y), wz = _mm256_mul_ps(w, z);
    const __m256 terms[10] = {w,
                              wx,
                              wy,
                              wz,
                              _mm256_mul_ps(wx, x),
                              _mm256_mul_ps(wx, y),
                              _mm256_mul_ps(wx, z),
                              _mm256_mul_ps(wy, y),
                              _mm256_mul_ps(wy, z),
                              _mm256_mul_ps(wz, z)};
    for (int t = 0; t < 10; ++t)
      all[t] = _mm256_add_ps(all[t], terms[t]);
    place = _mm256_add_epi32(place, _mm256_set1_epi32(8));
  }
  for (int t = 0; t < 10; ++t)
    sums[t] = total(all[t]);
}
} // namespace

const PlaneKernels* avx2PlaneKernels()
{
  static const PlaneKernels kernels = {fit, best, weightedSums};
  return __builtin_cpu_supports("avx2") ? &kernels : nullptr;
}
} // namespace fresco::filters
#else
namespace fresco::filters {
const PlaneKernels* avx2PlaneKernels() { return nullptr; }
} // namespace fresco::filters
#endif
