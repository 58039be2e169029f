// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/texture_io_image.h"
#include "io/texture/image_codecs.h"
#include <cstdint>
#include <cstring>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <zlib.h>
namespace fresco::io {
namespace {
std::uint32_t bigEndian(const unsigned char* at)
{
  return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 | at[3];
}

std::string_view view(const unsigned char* bytes, std::size_t size)
{
  return {reinterpret_cast<const char*>(bytes), size};
}
} // namespace

bool isIntactPng(const unsigned char* bytes, std::size_t size)
{
  if (!startsWith(view(bytes, size), "\x89PNG\r\n\x1a\n"))
    return false;
  // Chunk: length of the data, type, data, check sum of type and data.
  for (std::size_t at = 8; at + 12 <= size;) {
    const std::size_t length = bigEndian(bytes + at);
    if (length > size - at - 12 || crc32_z(0, bytes + at + 4, length + 4) != bigEndian(bytes + at + 8 + length))
      return false;
    if (std::memcmp(bytes + at + 4, "IEND", 4) == 0)
      return true;
    at += 12 + length;
  }
  return false;
}

Image decodeImage(const unsigned char* bytes, std::size_t size)
{
  cv::Mat bgr;
  const bool is_jpeg = startsWith(view(bytes, size), "\xff\xd8");
  if (size <= static_cast<std::size_t>(std::numeric_limits<int>::max()) && (is_jpeg || isIntactPng(bytes, size)))
    try {
      prepareImageCodecs();
      const cv::Mat raw(1, static_cast<int>(size), CV_8U, const_cast<unsigned char*>(bytes));
      bgr = cv::imdecode(raw, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (const cv::Exception&) { // reported below
    }
  if (bgr.empty())
    throw std::runtime_error("an image is damaged or neither PNG nor JPEG");
  Image image(bgr.cols, bgr.rows, 3);
  cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, image.data.data());
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return image;
}
} // namespace fresco::io
