// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "bilateral/candidate_features.h"
namespace fresco::filters {
/// How well directions fit a point, beside the normal it has: a network of two layers that benchmark/training/candidate_score.py
/// trains with scans of generated rooms. Worths of one point can be compared.
class DirectionWorth {
public:
  static constexpr int first_size = 16;
  using First = Eigen::Matrix<float, first_size, 1>;
  /// @param own figures of the normal that the point has
  explicit DirectionWorth(const DirectionFigures::Figures& own);
  float of(const DirectionFigures::Figures& figures) const;

private:
  First from_own_; ///< of the first layer
};
} // namespace fresco::filters
