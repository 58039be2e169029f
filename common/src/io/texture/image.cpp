// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/parse_file.h"
#include "io/texture/texture_io.h"
#include <algorithm>
#include <cstring>
#include <fresco/core/require.h>
#include <fresco/io/image_io.h>
#include <iterator>
#include <limits>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <zlib.h>
namespace fresco {
namespace {
bool startsWith(std::string_view bytes, std::string_view mark) { return bytes.substr(0, mark.size()) == mark; }

std::uint32_t bigEndian(const unsigned char* at)
{
  return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 | at[3];
}

/// Whether all chunks of a PNG are there and their check sums hold; libpng prints on stderr where they do not.
bool isIntactPng(std::string_view file)
{
  if (!startsWith(file, "\x89PNG\r\n\x1a\n"))
    return false;
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  // Chunk: length of the data, type, data, check sum of type and data.
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::size_t length = bigEndian(bytes + at);
    if (length > file.size() - at - 12 || crc32_z(0, bytes + at + 4, length + 4) != bigEndian(bytes + at + 8 + length))
      return false;
    if (std::memcmp(bytes + at + 4, "IEND", 4) == 0)
      return true;
    at += 12 + length;
  }
  return false;
}

/// Decoders fill in what a cut file lacks; its end tells whether it is whole.
bool isWhole(std::string_view bytes)
{
  if (startsWith(bytes, "\x89PNG"))
    return isIntactPng(bytes);
  if (startsWith(bytes, "\xff\xd8"))
    return bytes.rfind("\xff\xd9") != std::string::npos && bytes.rfind("\xff\xd9") > bytes.size() / 2;
  return true;
}

/// OpenCV also passes on to libraries that end the program over a damaged file (DICOM, GDAL's formats).
bool isCommonFormat(std::string_view bytes)
{
  using namespace std::string_view_literals;
  const bool is_webp = startsWith(bytes, "RIFF") && bytes.size() > 12 && bytes.compare(8, 4, "WEBP") == 0;
  const std::string_view marks[] = {"\x89PNG", "\xff\xd8", "II*\0"sv, "MM\0*"sv, "BM"};
  return is_webp || std::any_of(std::begin(marks), std::end(marks),
                                [&](std::string_view mark) { return startsWith(bytes, mark); });
}

/// To be called before OpenCV codes or decodes an image: its first use registers the drivers of GDAL, which print and
/// abort where memory ends. @throws std::bad_alloc if there is no room for them
void prepareImageCodecs()
{
  constexpr std::size_t room = 64 << 20; // bytes; registration takes about ten million
  static std::once_flag once;
  std::call_once(once, [] { // an exception leaves it to the next call
    std::vector<char>().reserve(room);
    std::vector<unsigned char> bytes;
    cv::imencode(".png", cv::Mat::zeros(1, 1, CV_8U), bytes);
  });
}

cv::Mat decode(std::string_view bytes, int flags)
{
  if (!isCommonFormat(bytes))
    throw std::runtime_error("no PNG, JPEG, TIFF, BMP or WebP image");
  if (!isWhole(bytes))
    throw std::runtime_error("the image is truncated or damaged");
  prepareImageCodecs();
  cv::Mat image;
  if (bytes.size() <= std::numeric_limits<int>::max())
    try {
      image = cv::imdecode(cv::Mat(1, int(bytes.size()), CV_8U, const_cast<char*>(bytes.data())), flags);
    } catch (const cv::Exception&) { // reported below: its text says nothing to a user
    }
  if (image.empty())
    throw std::runtime_error("no image that can be read");
  return image;
}

void validate(const Image& image)
{
  require(image.width > 0 && image.height > 0 && (image.channels == 1 || image.channels == 3 || image.channels == 4) &&
              image.data.size() == static_cast<std::size_t>(image.width) * image.height * image.channels,
          "image: ", image.width, "x", image.height, " with ", image.channels, " channels and ", image.data.size(),
          " bytes");
}

cv::Mat toOpenCv(const Image& image)
{
  const cv::Mat view(image.height, image.width, CV_8UC(image.channels), const_cast<std::uint8_t*>(image.data.data()));
  if (image.channels == 1)
    return view;
  cv::Mat swapped;
  cv::cvtColor(view, swapped, image.channels == 3 ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGRA);
  return swapped;
}
} // namespace

Image io::decodeImage(std::string_view bytes)
{
  const cv::Mat bgr = decode(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  Image image(bgr.cols, bgr.rows, 3);
  cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, image.data.data());
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return image;
}

Image readImage(const std::string& path) { return io::parseFile(path, io::decodeImage); }

Image16 readImage16(const std::string& path)
{
  return io::parseFile(path, [](std::string_view bytes) {
    const cv::Mat depth = decode(bytes, cv::IMREAD_UNCHANGED);
    if (depth.type() != CV_16UC1)
      throw std::runtime_error("not a 16-bit image with one channel");
    Image16 image{depth.cols, depth.rows, {}};
    image.data.reserve(depth.total());
    for (int y = 0; y < depth.rows; ++y)
      image.data.insert(image.data.end(), depth.ptr<std::uint16_t>(y), depth.ptr<std::uint16_t>(y) + depth.cols);
    return image;
  });
}

std::vector<std::uint8_t> encodeImage(const Image& image, const std::string& extension, int quality)
{
  require(quality >= 0 && quality <= 100, "image: quality ", quality, " is not in 0..100");
  require(extension == ".png" || extension == ".jpg" || extension == ".jpeg", "image: '", extension,
          "' is not .png, .jpg or .jpeg");
  validate(image);
  prepareImageCodecs();
  // With runs for matches: rows of a photograph, once filtered, repeat little else. The level resets the strategy.
  const std::vector<int> png = {cv::IMWRITE_PNG_COMPRESSION, 1, cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_RLE};
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, toOpenCv(image), bytes,
               extension == ".png" ? png : std::vector<int>{cv::IMWRITE_JPEG_QUALITY, quality});
  return bytes;
}

void writeImage(const std::string& path, const Image& image, int quality)
{
  const std::vector<std::uint8_t> bytes = encodeImage(image, extension(path), quality);
  writeFile(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}
} // namespace fresco
