// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/codecs.h"
#include "io/image/header_numbers.h"
#include <algorithm>
#include <cstdlib>
namespace fresco::io {
namespace {
constexpr std::size_t info = 14; // where the second header begins, with its length

struct BmpHeader {
  HeaderNumbers file;
  bool is_short = file.number(info, 4) == 12; // that of OS/2
  std::int32_t width = is_short ? file.number(18, 2) : file.number(18, 4);
  std::int32_t height = is_short ? file.number(20, 2) : file.number(22, 4); // negative: rows from the top
  std::uint32_t bits = file.number(is_short ? 24 : 28, 2);                  // of a pixel
  std::uint32_t compression = is_short ? 0 : file.number(30, 4);
};
} // namespace

ImageSize bmpSize(std::string_view bytes)
{
  const BmpHeader header{{bytes}};
  return {header.width, static_cast<int>(std::min(std::llabs(header.height), 0x7fffffffLL))};
}

Image decodeBmp(std::string_view bytes)
{
  const BmpHeader header{{bytes}};
  constexpr std::uint32_t plain = 0, with_masks = 3; // masks of 8 bits, blue first, are those of plain pixels
  const bool is_plain = header.compression == plain || (header.compression == with_masks && header.bits == 32 &&
                                                        header.file.number(54, 4) == 0xff0000);
  const bool has_palette = header.bits == 1 || header.bits == 4 || header.bits == 8;
  expect(is_plain && (has_palette || header.bits == 24 || header.bits == 32), "BMP: ", header.bits,
         " bits with compression ", header.compression, " are not supported");
  const ImageSize size = bmpSize(bytes);
  const std::size_t first = header.file.number(10, 4),
                    row_bytes = (std::size_t{header.bits} * size.width + 31) / 32 * 4;
  expect(first <= bytes.size() && (bytes.size() - first) / row_bytes >= static_cast<std::size_t>(size.height),
         "the image is truncated or damaged");
  const std::size_t palette = info + header.file.number(info, 4), entry = header.is_short ? 3 : 4;
  Image image(size.width, size.height, 3);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const std::size_t bit = std::size_t{header.bits} * x;
      std::size_t at = first + row_bytes * (header.height < 0 ? y : size.height - 1 - y) + bit / 8;
      if (has_palette)
        at = palette + entry * (header.file.number(at, 1) >> (8 - header.bits - bit % 8) & ((1U << header.bits) - 1));
      for (int c = 0; c < 3; ++c)
        image.pixel(x, y)[c] = header.file.number(at + 2 - c, 1);
    }
  return image;
}
} // namespace fresco::io
