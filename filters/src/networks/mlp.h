// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "networks/weights.h"
#include <Eigen/Core>
#include <initializer_list>
#include <vector>
namespace fresco::filters {
/// A multilayer perceptron with two hidden layers of rectified linear units and one output:
///
///   f = clip(features, lowest, highest)   (what lies beyond the training data counts as its limits)
///   a = max(0, W1' f + b1),   b = max(0, W2' a + b2),   output = w3 . b + b3
///
/// Matrices have a row per input. The first layer may have several matrices W1, one for each set of features.
template <int inputs, int first, int second>
class Mlp {
public:
  using Features = Eigen::Matrix<float, inputs, 1>;
  using Sums = Eigen::Matrix<float, first, 1>;

  /// @param weights lowest, highest, first_bias, second_weights, second_bias, last_weights, and the matrices W1;
  /// last_bias is left to callers
  /// @param matrices names of the matrices W1
  /// @throws std::runtime_error if one is missing or has another shape
  Mlp(const Weights& weights, std::initializer_list<const char*> matrices)
      : lowest_(weights.values("lowest", {1, inputs})), highest_(weights.values("highest", {1, inputs})),
        first_bias_(weights.values("first_bias", {1, first})),
        second_weights_(weights.values("second_weights", {first, second})),
        second_bias_(weights.values("second_bias", {1, second})),
        last_weights_(weights.values("last_weights", {second, 1}))
  {
    for (const char* name : matrices)
      first_weights_.emplace_back(weights.values(name, {inputs, first}));
  }

  /// W1' f of one of the matrices of the first layer.
  Sums firstSums(int matrix, const Features& features) const
  {
    const Features within = features.cwiseMax(lowest_).cwiseMin(highest_);
    return first_weights_[matrix] * within;
  }

  /// w3 . b.
  /// @param sums of the first layer, without its bias
  float output(const Sums& sums) const
  {
    const Sums a = (sums + first_bias_).cwiseMax(0.f);
    const Eigen::Matrix<float, second, 1> b = (second_weights_ * a + second_bias_).cwiseMax(0.f);
    return b.dot(last_weights_);
  }

private:
  template <int rows, int columns>
  using Map = Eigen::Map<const Eigen::Matrix<float, rows, columns>>;
  Map<inputs, 1> lowest_, highest_;
  std::vector<Map<first, inputs>> first_weights_;
  Map<first, 1> first_bias_;
  Map<second, first> second_weights_;
  Map<second, 1> second_bias_, last_weights_;
};
} // namespace fresco::filters
