// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/depth_map.h"
namespace fresco::texture {
/// Where a photograph's pixels lie so near to the outline of something that they mix it with what stands behind.
class OutlineMask {
public:
  OutlineMask() = default; ///< holds nothing
  /// @param reach pixels from the outline
  /// @param step  mesh units by which depth jumps at an outline; bends of one surface, however oblique, are none
  OutlineMask(const DepthMap& map, float reach, float step);

  /// Whether surface of that inverse depth lies behind an outline near the pixel.
  bool holds(const Eigen::Vector2f& pixel, float inverse_depth) const;
  /// Whether any pixel of the box is near an outline.
  bool touches(const Eigen::Vector2f& low, const Eigen::Vector2f& high) const;

private:
  Eigen::Vector2i cellUnder(const Eigen::Vector2f& pixel) const;

  int width_ = 0, height_ = 0;                           ///< cells
  float per_pixel_ = 0;                                  ///< cells
  std::vector<bool> near_;                               ///< cells near an outline
  std::vector<std::pair<std::uint32_t, float>> between_; ///< of these, ascending, inverse depth between both sides
};

} // namespace fresco::texture
