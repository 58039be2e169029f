// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "common/io/test_io_data.h"
#include <array>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <random>
/// What files of images are made of here, so that their pixels are known.
namespace fresco::test::images {
constexpr int width = 53, height = 41;

/// Rows of samples as a file keeps them: 16 bits as two bytes, the high one first, or one number a byte.
struct Samples {
  int channels, bits;
  std::vector<std::uint32_t> values; ///< width * height * channels

  Samples(int c, int b, unsigned seed = 5) : channels(c), bits(b), values(std::size_t{1} * width * height * c)
  {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < values.size(); ++i) // runs, repetitions and noise
      values[i] = (i % 7 < 4 ? i / 90 * 37 : random() % 11 * 5471) & ((1U << bits) - 1);
  }
  std::uint32_t at(int x, int y, int c) const { return values[(std::size_t{1} * y * width + x) * channels + c]; }
};

/// Expects the colours color(x, y, c).
template <typename Color>
void expectColors(const std::string& path, const Color& color)
{
  const Image image = readImage(path);
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  ASSERT_EQ(image.channels, 3);
  const ImageSize size = readImageSize(path);
  EXPECT_EQ(size.width, width);
  EXPECT_EQ(size.height, height);
  int wrong = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        wrong += image.pixel(x, y)[c] != color(x, y, c);
  EXPECT_EQ(wrong, 0) << path;
}

inline std::array<std::uint8_t, 3> paletteColor(std::uint32_t index)
{
  return {std::uint8_t(index * 29 + 3), std::uint8_t(255 - index), std::uint8_t(index * 7)};
}
} // namespace fresco::test::images
