// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "bilateral/candidate_features.h"
namespace fresco::filters {
/// How well candidates fit a point, beside the normal it has: a multilayer perceptron over the features of a candidate and
/// those of the own normal, trained with scans of generated rooms (docs/normal_smoothing.md). Scores of one
/// point can be compared.
class CandidateScore {
public:
  static constexpr int first_size = 16;
  using First = Eigen::Matrix<float, first_size, 1>;
  /// @param own features of the normal that the point has
  explicit CandidateScore(const NormalCandidateFeatures::Features& own);
  float of(const NormalCandidateFeatures::Features& features) const;

private:
  First from_own_; ///< of the first layer
};
} // namespace fresco::filters
