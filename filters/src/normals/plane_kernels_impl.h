// SPDX-License-Identifier: BSD-3-Clause
// The kernels, for the instructions that the including file is compiled for. No header with inline functions of external
// linkage may be used here: the linker could keep their AVX2 code for the whole program.
#pragma once
#include "normals/exponential.h"
#include "normals/plane_kernels.h"
namespace fresco::filters {
namespace {
using namespace simd;

/// cos(acos(-x) / 3) for x in -1..1: the polynomial of degree 10 that interpolates cos(2/3 acos(s)) at the Chebyshev
/// nodes of 0..1, s = sqrt((1 - x) / 2); error below 1e-10.
inline Double4 cosineOfThird(const Double4& x)
{
  constexpr double terms[] = {7.119253601992817e-07,   -1.9904683341565033e-06, 7.385892490739046e-06,
                              -2.8940260509409523e-05, 0.00011649489083714378,  -0.0005041210201816735,
                              0.0024663402760892843,   -0.015509188620848657,   0.24740906695252932,
                              0.766044443118978};
  const Double4 u = 2.0 * squareRoot((1.0 - x) * 0.5) - 1.0;
  Double4 value = Double4{} - 2.027307162548327e-07;
  for (const double term : terms)
    value = value * u + term;
  return value;
}

/// Least squares planes of four of the sets, from `first` on: the eigenvector of the smallest eigenvalue of the
/// covariances (Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix").
inline void fitFour(const EightMoments& moments, int first, EightPlanes& planes)
{
  Double4 sums[9];
  for (int s = 0; s < 9; ++s)
    sums[s] = widened(moments.sums[s] + first);
  const Double4 share = 1.0 / widened(moments.weight + first);
  const Double4 x = sums[0] * share, y = sums[1] * share, z = sums[2] * share;
  Double4 xx = sums[3] * share - x * x, xy = sums[4] * share - x * y, xz = sums[5] * share - x * z;
  Double4 yy = sums[6] * share - y * y, yz = sums[7] * share - y * z, zz = sums[8] * share - z * z;
  const Double4 trace = xx + yy + zz, scale = 1.0 / trace; // away from underflow
  xx = xx * scale, xy = xy * scale, xz = xz * scale, yy = yy * scale, yz = yz * scale, zz = zz * scale;
  // About the share of the middle one of the three variances.
  const Double4 second = xx * yy - xy * xy + (xx * zz - xz * xz) + (yy * zz - yz * yz);
  const double third = 1.0 / 3;
  const Double4 bx = xx - third, by = yy - third, bz = zz - third;
  const Double4 spread_squared = (bx * bx + by * by + bz * bz + 2.0 * (xy * xy + xz * xz + yz * yz)) * (1.0 / 6);
  const Double4 spread = squareRoot(spread_squared);
  const Double4 determinant = bx * (by * bz - yz * yz) - xy * (xy * bz - yz * xz) + xz * (xy * yz - by * xz);
  const Double4 ratio = determinant / (2.0 * spread_squared * spread), one = Double4{} + 1.0;
  const Double4 smallest = third - 2.0 * spread * cosineOfThird(smaller(larger(ratio, -one), one));
  xx = xx - smallest, yy = yy - smallest, zz = zz - smallest;
  // Of rank 1: n n^T times a number.
  const Double4 cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
  const Double4 cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
  const auto by_y = cxx < cyy, by_z = larger(cxx, cyy) < czz; // the longest column
  const Double4 n[3] = {by_z ? cxz : by_y ? cxy : cxx, by_z ? cyz : by_y ? cyy : cxy, by_z ? czz : by_y ? cyz : cxz};
  const Double4 squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2]; // 0 where all directions are alike
  const Double4 length = 1.0 / squareRoot(squared), mean[3] = {x, y, z};
  for (int axis = 0; axis < 3; ++axis) {
    store(n[axis] * length, planes.normal[axis] + first);
    store(mean[axis], planes.center[axis] + first);
  }
  const Double4 curvature = larger(Double4{}, smallest);
  store(curvature, planes.curvature + first);
  store(larger(curvature, Double4{} + rounding_share) * trace, planes.variance + first);
  const auto told = (trace > 0.0) & (trace < __builtin_inf()) & (second > rounding_share) & (squared > 0.0);
  for (int lane = 0; lane < 4; ++lane)
    planes.planes |= (told[lane] & 1u) << (first + lane);
}

inline void fit(const EightMoments& moments, EightPlanes& planes)
{
  planes.planes = 0;
  fitFour(moments, 0, planes);
  fitFour(moments, 4, planes);
}

/// Rows to columns.
inline void transpose(const Float8 (&row)[8], Float8 (&column)[8])
{
#ifdef __AVX2__
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
#else
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      column[j][i] = row[i][j];
#endif
}

inline BestPlane best(const float* planes, const std::uint16_t* list, std::size_t count, const float* own,
                      const float* point)
{
  Float8 scores = infinities, cosines = Float8{} + 1.f;
  Int8 which = {}, place = lane_numbers;
  for (std::size_t j = 0; j < count; j += 8, place += 8) {
    Float8 row[8], p[8];
    for (std::size_t i = 0; i < 8; ++i) // the last one again for those that are missing
      row[i] = load<Float8>(planes + 8 * std::size_t{list[j + i < count ? j + i : count - 1]});
    transpose(row, p);
    const Float8 cosine = p[0] * own[0] + p[1] * own[1] + p[2] * own[2];
    cosines = smaller(larger(cosine, -cosine), cosines);
    const Float8 distance = p[0] * (point[0] - p[4]) + p[1] * (point[1] - p[5]) + p[2] * (point[2] - p[6]);
    const Float8 score = p[3] + 0.5f * (distance * distance);
    const Int8 better = score < scores;
    scores = better ? score : scores;
    which = better ? place : which;
  }
  BestPlane result = {scores[0], cosines[0], which[0]};
  for (int i = 1; i < 8; ++i) {
    result.closest = smaller(cosines[i], result.closest);
    if (scores[i] < result.score || (scores[i] == result.score && which[i] < result.which)) {
      result.score = scores[i];
      result.which = which[i];
    }
  }
  return result;
}

inline void weightedSums(const WeightedPoints& points, const float* plane, float scale, float* sums)
{
  Float8 all[10] = {};
  Int8 place = lane_numbers;
  for (std::size_t i = 0; i < points.count; i += 8, place += 8) {
    const Int8 in = place < int(points.count);
    const Float8 none = {}, x = in ? load<Float8>(points.x + i) : none, y = in ? load<Float8>(points.y + i) : none,
                 z = in ? load<Float8>(points.z + i) : none;
    const Float8 distance = x * plane[0] + y * plane[1] + z * plane[2] - plane[3];
    const Float8 w = in ? exponential(scale * (distance * distance)) : none, wx = w * x, wy = w * y, wz = w * z;
    const Float8 terms[10] = {w, wx, wy, wz, wx * x, wx * y, wx * z, wy * y, wy * z, wz * z};
    for (int t = 0; t < 10; ++t)
      all[t] += terms[t];
  }
  for (int t = 0; t < 10; ++t)
    sums[t] = total(all[t]);
}

inline constexpr PlaneKernels kernels = {fit, best, weightedSums};
} // namespace
} // namespace fresco::filters
