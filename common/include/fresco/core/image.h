// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>
namespace fresco {
/// 8-bit image, rows from the top, interleaved.
struct Image {
  int width = 0, height = 0;
  int channels = 3; ///< 1 grey, 3 RGB, 4 RGBA
  std::vector<std::uint8_t> data;

  Image() = default;
  Image(int w, int h, int c = 3, std::uint8_t value = 0)
      : width(w), height(h), channels(c), data(static_cast<std::size_t>(w) * h * c, value)
  {}
  bool empty() const { return data.empty(); }
  std::uint8_t* pixel(int x, int y) { return data.data() + (static_cast<std::size_t>(y) * width + x) * channels; }
  const std::uint8_t* pixel(int x, int y) const
  {
    return data.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
};

/// 16-bit image of one channel, rows from the top: depth images.
struct Image16 {
  int width = 0, height = 0;
  std::vector<std::uint16_t> data;
};

/// height x width depths along the viewing axis, in the unit of the poses. 0, negative or not finite = none.
using DepthImage = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
} // namespace fresco
