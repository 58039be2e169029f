// SPDX-License-Identifier: BSD-3-Clause
#include "baking/texel_fill.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::deliverables {
Image halved(const Image& image, std::vector<std::uint8_t>& painted)
{
  Image half((image.width + 1) / 2, (image.height + 1) / 2);
  std::vector<std::uint8_t> half_painted(std::size_t(half.width) * half.height, 0);
  parallelFor(half.height, 0, [&](Index y) {
    for (int x = 0; x < half.width; ++x) {
      int count = 0, sums[3] = {0, 0, 0};
      for (int row = 2 * y; row < std::min<int>(2 * y + 2, image.height); ++row)
        for (int column = 2 * x; column < std::min(2 * x + 2, image.width); ++column) {
          if (painted[std::size_t(row) * image.width + column] == 0)
            continue;
          ++count;
          for (int k = 0; k < 3; ++k)
            sums[k] += image.pixel(column, row)[k];
        }
      half_painted[std::size_t(y) * half.width + x] = count > 0 ? 1 : 0;
      for (int k = 0; k < 3 && count > 0; ++k)
        half.pixel(x, y)[k] = (sums[k] + count / 2) / count;
    }
  });
  painted = std::move(half_painted);
  return half;
}

void fillUnpainted(Image& image, std::vector<std::uint8_t> painted)
{
  if (image.width * image.height <= 1 || std::find(painted.begin(), painted.end(), 0) == painted.end())
    return;
  std::vector<std::uint8_t> half_painted = painted;
  Image half = halved(image, half_painted);
  fillUnpainted(half, std::move(half_painted));
  parallelFor(image.height, 0, [&](Index y) {
    for (int x = 0; x < image.width; ++x)
      if (painted[std::size_t(y) * image.width + x] == 0)
        std::copy_n(half.pixel(x / 2, y / 2), 3, image.pixel(x, y));
  });
}
} // namespace fresco::deliverables
