// SPDX-License-Identifier: BSD-3-Clause
// Depths as floats: PFM (Debevec 1998, portable float map) and NPY (NumPy Enhancement Proposal 1).
#include "io/image/codecs.h"
#include "io/image/header_numbers.h"
#include "io/points/text_numbers.h"
#include <cmath>
#include <cstring>
namespace fresco::io {
namespace {
struct FloatLayout {
  ImageSize size;
  std::size_t begin = 0, bytes = 4; ///< of the values, of one of them
  bool low_first = true, from_below = false;
};

int lengthOf(std::string_view word)
{
  constexpr double longest = 1 << 20; // pixels
  const auto value = parseNumber<double>(word);
  expect(value >= 1 && value <= longest && value == std::floor(value), "an image of an impossible size");
  return int(value);
}

FloatLayout pfmLayout(std::string_view bytes)
{
  TextScanner words(bytes.substr(2));
  FloatLayout out;
  out.size.width = lengthOf(words.wordAcrossLines());
  out.size.height = lengthOf(words.wordAcrossLines());
  out.low_first = parseNumber<double>(words.wordAcrossLines()) < 0; // its sign tells the order of bytes
  out.begin = bytes.size() - words.remaining() + 1;                 // behind one blank
  out.from_below = true;
  return out;
}

FloatLayout npyLayout(std::string_view bytes)
{
  const HeaderNumbers numbers{bytes};
  const bool first_version = numbers.number(6, 1) == 1;
  FloatLayout out;
  out.begin = first_version ? 10 + numbers.number(8, 2) : 12 + numbers.number(8, 4);
  const std::string_view head = bytes.substr(10, out.begin - std::min<std::size_t>(out.begin, 10));
  const auto after = [&](std::string_view key) {
    const std::size_t at = head.find(key);
    return at == std::string_view::npos ? std::string_view() : head.substr(at + key.size());
  };
  const std::string_view shape = after("'shape': (");
  const std::size_t comma = shape.find(','), end = shape.find(')');
  const bool is_double = !after("'<f8'").empty();
  expect((is_double || !after("'<f4'").empty()) && !after("'fortran_order': False").empty() &&
             end != std::string_view::npos && comma < end,
         "NPY: no array of rows of floats (f4 or f8, low byte first)");
  out.bytes = is_double ? 8 : 4;
  out.size.height = lengthOf(TextScanner(shape.substr(0, comma)).word());
  out.size.width = lengthOf(TextScanner(shape.substr(comma + 1, end - comma - 1)).word());
  return out;
}

FloatImage decoded(std::string_view bytes, const FloatLayout& layout)
{
  const std::size_t width = layout.size.width, height = layout.size.height;
  expect(layout.begin <= bytes.size() && bytes.size() - layout.begin >= width * height * layout.bytes,
         "the image is truncated or damaged");
  FloatImage image{int(width), int(height), std::vector<float>(width * height)};
  const HeaderNumbers numbers{bytes, layout.low_first};
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const std::size_t row = i / width, from = layout.from_below ? (height - 1 - row) * width + i % width : i;
    const std::size_t at = layout.begin + layout.bytes * from;
    const std::uint32_t low = numbers.number(at, 4);
    if (layout.bytes == 4) {
      std::memcpy(&image.data[i], &low, sizeof low);
      continue;
    }
    const std::uint64_t both = std::uint64_t{numbers.number(at + 4, 4)} << 32 | low;
    double value = 0;
    std::memcpy(&value, &both, sizeof value);
    image.data[i] = static_cast<float>(value);
  }
  return image;
}
} // namespace

ImageSize pfmSize(std::string_view bytes) { return pfmLayout(bytes).size; }
FloatImage decodePfm(std::string_view bytes) { return decoded(bytes, pfmLayout(bytes)); }
ImageSize npySize(std::string_view bytes) { return npyLayout(bytes).size; }
FloatImage decodeNpy(std::string_view bytes) { return decoded(bytes, npyLayout(bytes)); }
} // namespace fresco::io
