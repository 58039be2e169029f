// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// Weights of residuals in iteratively reweighted least squares, functions of the squared residual over the squared scale.
namespace fresco {
/// Cauchy: 1 / (1 + s). @param s (residual / scale)^2, >= 0 @returns 0..1 (Zhang 1997, "Parameter estimation
/// techniques", table 1; so the others)
template <typename Scalar>
constexpr Scalar cauchyWeight(Scalar s)
{
  return 1 / (1 + s);
}

/// Geman & McClure: 1 / (1 + s)^2. @param s (residual / scale)^2, >= 0 @returns 0..1
template <typename Scalar>
constexpr Scalar gemanMcClureWeight(Scalar s)
{
  return 1 / ((1 + s) * (1 + s));
}

/// Tukey's biweight: (1 - s)^2 within the scale, 0 from there on. @param s (residual / scale)^2, >= 0 @returns 0..1
template <typename Scalar>
constexpr Scalar tukeyWeight(Scalar s)
{
  return s < 1 ? (1 - s) * (1 - s) : 0;
}
} // namespace fresco
