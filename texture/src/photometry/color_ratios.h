// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
#include <map>
namespace fresco::texture {
constexpr Index most_compared = 40000; ///< places: far more than the unknowns ask for
constexpr int reweightings = 10;       ///< of least squares
constexpr double usual_error = 0.03;   ///< of logarithms of light: what is off by more than 3 % counts less (Cauchy)

/// One patch in two views.
struct ColorRatio {
  Eigen::Vector3f log_ratio; ///< of the first view's colour over the second's
  Eigen::Vector3f log_mean;  ///< mean of the colours' logarithms, as photographed
  float radius[2];           ///< squared, in either photograph
  float contrast;            ///< octaves of the first's relative variance within the patch over the second's; NaN: none
};

/// By the pair of views' owners.
using ColorRatios = std::map<std::pair<int, int>, std::vector<ColorRatio>>;

/// From patches spread over the whole mesh, where both views show them well and neither too dark nor too bright.
/// @param owner per view what it is a part of: parts of one are not compared
ColorRatios collectColorRatios(const Candidates& candidates, const std::vector<int>& owner);
} // namespace fresco::texture
