// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/parse_file.h"
#include "io/texture/image_codecs.h"
#include "io/texture/png_writer.h"
#include "io/texture/texture_io_image.h"
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
namespace fresco {
namespace {
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

Image readImage(const std::string& path) { return io::parseFile(path, io::decodeImage); }

Image16 readImage16(const std::string& path) { return io::parseFile(path, io::decodeImage16); }

std::vector<std::uint8_t> encodeImage(const Image& image, const std::string& extension, int quality)
{
  require(quality >= 0 && quality <= 100, "image: quality ", quality, " is not in 0..100");
  require(extension == ".png" || extension == ".jpg" || extension == ".jpeg", "image: '", extension,
          "' is not .png, .jpg or .jpeg");
  validate(image);
  if (extension == ".png")
    return io::encodePng(image);
  io::prepareImageCodecs();
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, toOpenCv(image), bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
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
