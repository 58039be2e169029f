// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/image_size.h"
#include <algorithm>
#include <cstdlib>
namespace fresco::io {
namespace {
/// Numbers of a header in either byte order; 0 beyond its end.
struct Header {
  std::string_view bytes;
  bool low_first = true;

  std::uint32_t number(std::size_t at, std::size_t length) const
  {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t place = at + (low_first ? length - 1 - i : i);
      value = value << 8 | (place < bytes.size() ? static_cast<unsigned char>(bytes[place]) : 0U);
    }
    return value;
  }
};

std::uint64_t ofBmp(const Header& bmp)
{
  if (bmp.number(14, 4) == 12) // the header of OS/2
    return std::uint64_t{bmp.number(18, 2)} * bmp.number(20, 2);
  const auto side = [&](std::size_t at) { // a negative height: rows from the top
    return static_cast<std::uint64_t>(std::llabs(static_cast<std::int32_t>(bmp.number(at, 4))));
  };
  return side(18) * side(22);
}

std::uint64_t ofWebp(const Header& webp)
{
  const std::string_view chunk = webp.bytes.substr(std::min<std::size_t>(12, webp.bytes.size()), 4);
  constexpr std::uint32_t fourteen_bits = 0x3fff;
  if (chunk == "VP8X")
    return (std::uint64_t{webp.number(24, 3)} + 1) * (std::uint64_t{webp.number(27, 3)} + 1);
  if (chunk == "VP8L")
    return (std::uint64_t{webp.number(21, 4) & fourteen_bits} + 1) * ((webp.number(21, 4) >> 14 & fourteen_bits) + 1);
  return std::uint64_t{webp.number(26, 2) & fourteen_bits} * (webp.number(28, 2) & fourteen_bits);
}

std::uint64_t ofTiff(const Header& tiff)
{
  constexpr std::uint32_t width_tag = 256, height_tag = 257, short_type = 3, most_entries = 4096;
  const std::size_t table = tiff.number(4, 4);
  const std::uint32_t entries = std::min(tiff.number(table, 2), most_entries);
  std::uint64_t width = 0, height = 0;
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::size_t entry = table + 2 + std::size_t{12} * i;
    const std::uint32_t value = tiff.number(entry + 8, tiff.number(entry + 2, 2) == short_type ? 2 : 4);
    if (tiff.number(entry, 2) == width_tag)
      width = value;
    if (tiff.number(entry, 2) == height_tag)
      height = value;
  }
  return width * height;
}
} // namespace

std::uint64_t pixelsOf(std::string_view image)
{
  const std::string_view mark = image.substr(0, 2);
  if (mark == "BM")
    return ofBmp({image});
  if (mark == "RI")
    return ofWebp({image});
  return mark == "II" || mark == "MM" ? ofTiff({image, mark == "II"}) : 0;
}
} // namespace fresco::io
