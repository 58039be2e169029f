// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "cameras/grey_pyramid.h"
namespace fresco::texture {
/// A small square of one photograph to be found in another.
struct PatchQuery {
  const GreyPyramid& from;
  const GreyPyramid& to;
  Eigen::Vector2f pixel_from, pixel_to; ///< level 0 of each; pixel_to is where it is expected
  Eigen::Matrix2f T_from_to;            ///< offset in `from` per offset in `to`, both in level 0 pixels
  float search;                         ///< level 0 pixels around pixel_to
};

/// Finds it coarse to fine by normalised cross correlation.
/// @param place level 0 pixels of `to`
/// @return false unless one place is clearly the best and good
bool findPatch(const PatchQuery& query, Eigen::Vector2f& place);
} // namespace fresco::texture
