// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/parse_file.h"
#include "io/texture/image_size.h"
#include "io/texture/jpeg_reader.h"
#include "io/texture/png_writer.h"
#include "io/texture/texture_io.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <iterator>
#include <limits>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <zlib.h>
namespace fresco {
namespace {
using namespace std::string_view_literals;

bool startsWith(std::string_view bytes, std::string_view mark) { return bytes.substr(0, mark.size()) == mark; }

std::uint32_t bigEndian(std::string_view bytes, std::size_t at)
{
  std::uint32_t value = 0;
  for (const unsigned char byte : bytes.substr(at, 4))
    value = value << 8 | byte;
  return value;
}

/// Whether all chunks are there and their check sums hold; libpng prints on stderr where they do not.
bool hasIntactChunks(std::string_view png)
{
  // Chunk: length of the data, type, data, check sum of type and data.
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t length = bigEndian(png, at);
    if (length > png.size() - at - 12)
      return false;
    const auto* type = reinterpret_cast<const unsigned char*>(png.data()) + at + 4;
    if (crc32_z(0, type, length + 4) != bigEndian(png, at + 8 + length))
      return false;
    if (png.substr(at + 4, 4) == "IEND")
      return true;
    at += 12 + length;
  }
  return false;
}

/// Whether so many pixels can be in so few bytes: checked before room is made for them.
bool hasPossibleSize(std::string_view png)
{
  constexpr std::uint64_t best_ratio = 1032; // of zlib
  constexpr std::size_t header_end = 33;     // signature and chunk IHDR: width, height, bits and kind of the samples
  if (png.size() < header_end || png.substr(12, 4) != "IHDR")
    return false;
  const std::uint64_t row = (std::uint64_t{bigEndian(png, 16)} * static_cast<unsigned char>(png[24]) + 7) / 8;
  return bigEndian(png, 20) <= best_ratio * png.size() / std::max<std::uint64_t>(row, 1);
}

/// The same of the other formats, whose codes have no such bound: images of one colour are small in all of them.
bool hasLikelySize(std::string_view bytes)
{
  constexpr std::uint64_t always = 1 << 24, best_ratio = 4096; // pixels; pixels per byte
  const std::uint64_t pixels = io::pixelsOf(bytes);
  return pixels > 0 && pixels <= std::max(always, best_ratio * bytes.size());
}

/// OpenCV also passes on to libraries that end the program over a damaged file (DICOM, GDAL's formats).
bool isCommonFormat(std::string_view bytes)
{
  const bool is_webp = startsWith(bytes, "RIFF") && bytes.size() > 12 && bytes.substr(8, 4) == "WEBP";
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
  const bool is_png = startsWith(bytes, "\x89PNG");
  const bool is_jpeg = startsWith(bytes, "\xff\xd8");
  if (!(is_png ? hasIntactChunks(bytes) && hasPossibleSize(bytes) : is_jpeg || hasLikelySize(bytes)) ||
      bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::runtime_error("the image is truncated or damaged");
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  prepareImageCodecs();
  cv::Mat image;
  try {
    image = cv::imdecode(raw, flags);
  } catch (const cv::Exception&) { // its text has several lines
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

Image decodeImage(std::string_view bytes)
{
  if (startsWith(bytes, "\xff\xd8"))
    return io::decodeJpeg(bytes);
  const cv::Mat bgr = decode(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  Image image(bgr.cols, bgr.rows, 3);
  cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, image.data.data());
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return image;
}

Image readImage(const std::string& path) { return io::parseFile(path, decodeImage); }

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

std::string maskFileOf(const std::string& folder, const std::string& name)
{
  namespace fs = std::filesystem;
  for (const fs::path& masks : {fs::path(folder) / "masks", fs::path(folder) / ".." / "masks"})
    for (const std::string& file : {fs::path(name).replace_extension(".png").string(), name + ".png"})
      if (std::error_code none; fs::exists(masks / file, none))
        return (masks / file).string();
  return "";
}

std::vector<std::uint8_t> encodeImage(const Image& image, const std::string& extension, int quality)
{
  require(quality >= 0 && quality <= 100, "image: quality ", quality, " is not in 0..100");
  require(extension == ".png" || extension == ".jpg" || extension == ".jpeg", "image: '", extension,
          "' is not .png, .jpg or .jpeg");
  validate(image);
  if (extension == ".png")
    return io::encodePng(image);
  prepareImageCodecs();
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, toOpenCv(image), bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return bytes;
}

void writeImage(const std::string& path, const Image& image, int quality)
{
  const std::vector<std::uint8_t> bytes = encodeImage(image, extension(path), quality);
  writeFile(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}
} // namespace fresco
