// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/codecs.h"
#include <webp/decode.h>
namespace fresco::io {
namespace {
const std::uint8_t* begin(std::string_view bytes) { return reinterpret_cast<const std::uint8_t*>(bytes.data()); }
} // namespace

ImageSize webpSize(std::string_view bytes)
{
  ImageSize size;
  WebPGetInfo(begin(bytes), bytes.size(), &size.width, &size.height);
  return size;
}

Image decodeWebp(std::string_view bytes)
{
  const ImageSize size = webpSize(bytes);
  Image image(size.width, size.height, 3);
  expect(WebPDecodeRGBInto(begin(bytes), bytes.size(), image.data.data(), image.data.size(), 3 * image.width),
         "the image is truncated or damaged");
  return image;
}
} // namespace fresco::io
