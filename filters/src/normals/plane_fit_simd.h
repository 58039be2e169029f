// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#ifndef FRESCO_SIMD_TARGET
#define FRESCO_SIMD_TARGET // attributes of functions that are compiled for certain processors
#endif
namespace fresco::filters {
namespace {
/// cos(acos(-x) / 3) for x in -1..1: the polynomial of degree 10 that interpolates cos(2/3 acos(s)) at the Chebyshev
/// nodes of 0..1, s = sqrt((1 - x) / 2); error below 1e-10.
template <typename T>
FRESCO_SIMD_TARGET inline T cosineOfThird(const T& x)
{
  constexpr double terms[] = {-2.027307162548327e-07, 7.119253601992817e-07,   -1.9904683341565033e-06,
                              7.385892490739046e-06,  -2.8940260509409523e-05, 0.00011649489083714378,
                              -0.0005041210201816735, 0.0024663402760892843,   -0.015509188620848657,
                              0.24740906695252932,    0.766044443118978};
  const T u = T(2.0) * squareRoot((T(1.0) - x) * T(0.5)) - T(1.0);
  T value(terms[0]);
  for (int i = 1; i < 11; ++i)
    value = value * u + T(terms[i]);
  return value;
}

template <typename T>
struct SimdPlanes {
  T normal[3], center[3], variance, curvature;
  T trace;   ///< sum of the three variances
  T second;  ///< about the share of the middle one
  T squared; ///< 0 where all directions are alike
};

/// Least squares planes of as many sets of points as T has lanes: the eigenvector of the smallest eigenvalue of the
/// covariances (Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix").
/// @param sums x, y, z, xx, xy, xz, yy, yz, zz
template <typename T>
FRESCO_SIMD_TARGET inline SimdPlanes<T> fitPlanes(const T& weight, const T* sums)
{
  SimdPlanes<T> fit;
  const T share = T(1.0) / weight, x = sums[0] * share, y = sums[1] * share, z = sums[2] * share;
  T xx = sums[3] * share - x * x, xy = sums[4] * share - x * y, xz = sums[5] * share - x * z;
  T yy = sums[6] * share - y * y, yz = sums[7] * share - y * z, zz = sums[8] * share - z * z;
  fit.trace = xx + yy + zz;
  const T scale = T(1.0) / fit.trace; // away from underflow
  xx = xx * scale, xy = xy * scale, xz = xz * scale, yy = yy * scale, yz = yz * scale, zz = zz * scale;
  fit.second = xx * yy - xy * xy + (xx * zz - xz * xz) + (yy * zz - yz * yz);
  const T third(1.0 / 3), bx = xx - third, by = yy - third, bz = zz - third;
  const T spread_squared = (bx * bx + by * by + bz * bz + T(2.0) * (xy * xy + xz * xz + yz * yz)) * T(1.0 / 6);
  const T spread = squareRoot(spread_squared);
  const T determinant = bx * (by * bz - yz * yz) - xy * (xy * bz - yz * xz) + xz * (xy * yz - by * xz);
  const T ratio = determinant / (T(2.0) * spread_squared * spread);
  const T smallest = third - T(2.0) * spread * cosineOfThird(least(most(ratio, T(-1.0)), T(1.0)));
  xx = xx - smallest, yy = yy - smallest, zz = zz - smallest;
  // Of rank 1: n n^T times a number.
  const T cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
  const T cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
  const T first = ifLess(cxx, cyy, cxy, cxx), top = most(cxx, cyy);
  T n[3] = {ifLess(top, czz, cxz, first), ifLess(top, czz, cyz, ifLess(cxx, cyy, cyy, cxy)),
            ifLess(top, czz, czz, ifLess(cxx, cyy, cyz, cxz))};
  fit.squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const T length = T(1.0) / squareRoot(fit.squared);
  for (int axis = 0; axis < 3; ++axis)
    fit.normal[axis] = n[axis] * length;
  fit.center[0] = x, fit.center[1] = y, fit.center[2] = z;
  fit.curvature = most(T(0.0), smallest);
  fit.variance = most(fit.curvature, T(rounding_share)) * fit.trace;
  return fit;
}
} // namespace
} // namespace fresco::filters
