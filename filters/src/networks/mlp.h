// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
/// Networks of two layers of rectifiers over figures. Weights are structs that benchmark/training/mlp.py writes; matrices
/// lie there row by row, a row for each input.
namespace fresco::filters {
template <typename Weights>
using NetworkInputs = Eigen::Matrix<float, Weights::inputs, 1>;
template <typename Weights>
using FirstLayer = Eigen::Matrix<float, Weights::first, 1>;

/// What the first layer gets from figures by one of its matrices; figures beyond what was seen in training count as its
/// limits.
template <typename Weights>
FirstLayer<Weights> firstSums(const float* matrix, const NetworkInputs<Weights>& figures)
{
  using Limits = Eigen::Map<const NetworkInputs<Weights>>;
  const NetworkInputs<Weights> within = figures.cwiseMax(Limits(Weights::lowest)).cwiseMin(Limits(Weights::highest));
  return Eigen::Map<const Eigen::Matrix<float, Weights::first, Weights::inputs>>(matrix) * within;
}

/// @param sums of the first layer, without its bias
template <typename Weights>
float networkOutput(const FirstLayer<Weights>& sums)
{
  using Second = Eigen::Matrix<float, Weights::second, 1>;
  using Values = Eigen::Map<const Second>;
  const Eigen::Map<const Eigen::Matrix<float, Weights::second, Weights::first>> W(Weights::second_weights);
  const FirstLayer<Weights> a = (sums + Eigen::Map<const FirstLayer<Weights>>(Weights::first_bias)).cwiseMax(0.f);
  const Second b = (W * a + Values(Weights::second_bias)).cwiseMax(0.f);
  return b.dot(Values(Weights::last_weights));
}
} // namespace fresco::filters
