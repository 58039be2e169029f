// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/image_codecs.h"
#include "io/texture/texture_io_image.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
namespace fresco {
namespace {
[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
  throw std::runtime_error(path + ": " + reason);
}

/// Decoders fill in what a cut file lacks; its end tells whether it is whole.
bool isWhole(const std::string& bytes)
{
  if (io::startsWith(bytes, "\x89PNG"))
    return io::isIntactPng(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  if (io::startsWith(bytes, "\xff\xd8"))
    return bytes.rfind("\xff\xd9") != std::string::npos && bytes.rfind("\xff\xd9") > bytes.size() / 2;
  return true;
}

/// OpenCV also passes on to libraries that end the program over a damaged file (DICOM, GDAL's formats).
bool isCommonFormat(const std::string& bytes)
{
  using namespace std::string_view_literals;
  const bool is_webp = io::startsWith(bytes, "RIFF") && bytes.size() > 12 && bytes.compare(8, 4, "WEBP") == 0;
  const std::string_view marks[] = {"\x89PNG", "\xff\xd8", "II*\0"sv, "MM\0*"sv, "BM"};
  return is_webp || std::any_of(std::begin(marks), std::end(marks),
                                [&](std::string_view mark) { return io::startsWith(bytes, mark); });
}

cv::Mat decode(const std::string& path, int flags)
{
  const std::string bytes = readFile(path);
  if (!isCommonFormat(bytes))
    fail(path, "no PNG, JPEG, TIFF, BMP or WebP image");
  if (!isWhole(bytes))
    fail(path, "the image is truncated or damaged");
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  io::prepareImageCodecs();
  cv::Mat image;
  try {
    image = cv::imdecode(raw, flags);
  } catch (const cv::Exception&) { // its text names no file
    fail(path, "no image that can be read");
  }
  if (image.empty())
    fail(path, "no image that can be read");
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

Image readImage(const std::string& path)
{
  const cv::Mat bgr = decode(path, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  Image image(bgr.cols, bgr.rows, 3);
  cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, image.data.data());
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return image;
}

Image16 readImage16(const std::string& path)
{
  const cv::Mat depth = decode(path, cv::IMREAD_UNCHANGED);
  if (depth.type() != CV_16UC1)
    fail(path, "not a 16-bit image with one channel");
  Image16 image{depth.cols, depth.rows, {}};
  image.data.reserve(depth.total());
  for (int y = 0; y < depth.rows; ++y)
    image.data.insert(image.data.end(), depth.ptr<std::uint16_t>(y), depth.ptr<std::uint16_t>(y) + depth.cols);
  return image;
}

std::vector<std::uint8_t> encodeImage(const Image& image, const std::string& extension, int quality)
{
  require(quality >= 0 && quality <= 100, "image: quality ", quality, " is not in 0..100");
  require(extension == ".png" || extension == ".jpg" || extension == ".jpeg", "image: '", extension,
          "' is not .png, .jpg or .jpeg");
  validate(image);
  io::prepareImageCodecs();
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
  OutputFile file(path);
  file.write(bytes.data(), bytes.size());
  file.commit();
}
} // namespace fresco
