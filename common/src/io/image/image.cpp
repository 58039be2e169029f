// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/codecs.h"
#include "io/points/parse_file.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/camera.h>
#include <fresco/io/file.h>
namespace fresco {
namespace {
using namespace std::string_view_literals;

struct ImageFormat {
  std::vector<std::string_view> marks; ///< one of which begins a file
  std::size_t pixels_per_byte;         ///< more cannot be packed into a byte of a file, or are not trusted to be
  ImageSize (*size)(std::string_view);
  Image (*decode)(std::string_view);                           ///< nullptr: it holds no picture
  Image16 (*decode16)(std::string_view) = nullptr;             ///< empty if the file has no grey of 16 bits
  io::FloatImage (*decode_floats)(std::string_view) = nullptr; ///< empty if it has none
};

const ImageFormat& formatOf(std::string_view bytes)
{
  static const ImageFormat formats[] = {
      {{"\x89PNG"}, 8 * 1032, io::pngSize, io::decodePng, io::decodePng16}, // 1 bit a pixel, zlib's best ratio
      {{"\xff\xd8"}, 512, io::jpegSize, io::decodeJpeg},                    // a block of 64 pixels takes a bit at least
      {{"II*\0"sv, "MM\0*"sv}, 4096, io::tiffSize, io::decodeTiff, io::decodeTiff16, io::decodeTiffFloats},
      {{"BM"}, 8, io::bmpSize, io::decodeBmp},
      {{"RIFF"}, 4096, io::webpSize, io::decodeWebp},
      {{"Pf\n", "Pf\r", "Pf "}, 1, io::pfmSize, nullptr, nullptr, io::decodePfm},
      {{"\x93NUMPY"}, 1, io::npySize, nullptr, nullptr, io::decodeNpy},
  };
  const auto begins = [&](std::string_view mark) { return bytes.substr(0, mark.size()) == mark; };
  for (const ImageFormat& format : formats)
    if (std::any_of(format.marks.begin(), format.marks.end(), begins))
      return format;
  throw std::runtime_error(begins("v/1\x01")
                               ? "OpenEXR is not read: 'oiiotool IN.exr --ch Z -o OUT.tif' (Debian's package "
                                 "openimageio-tools) makes a TIFF of floats of its channel Z"
                               : "no PNG, JPEG, TIFF, BMP or WebP image");
}

/// The size that the header tells, which may be packed into so few bytes: checked before room is made for the pixels.
ImageSize sizeOf(std::string_view bytes, const ImageFormat& format)
{
  const ImageSize size = format.size(bytes);
  constexpr std::size_t always = 1 << 24; // pixels: images of one colour are small
  expect(size.width > 0 && size.height > 0 &&
             std::size_t{1} * size.width * size.height <= std::max(always, format.pixels_per_byte * bytes.size()),
         "the image is truncated or damaged");
  return size;
}

void validate(const Image& image)
{
  require(image.width > 0 && image.height > 0 && (image.channels == 1 || image.channels == 3 || image.channels == 4) &&
              image.data.size() == static_cast<std::size_t>(image.width) * image.height * image.channels,
          "image: ", image.width, "x", image.height, " with ", image.channels, " channels and ", image.data.size(),
          " bytes");
}

void write(const std::string& path, const std::vector<std::uint8_t>& bytes)
{
  writeFile(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}
} // namespace

Image decodeImage(std::string_view bytes)
{
  const ImageFormat& format = formatOf(bytes);
  sizeOf(bytes, format);
  expect(format.decode, "holds depths (floats), no picture");
  return format.decode(bytes);
}

ImageSize readImageSize(const std::string& path)
{
  return io::parseFile(path, [](std::string_view bytes) { return sizeOf(bytes, formatOf(bytes)); });
}

Image readImage(const std::string& path) { return io::parseFile(path, decodeImage); }

void requireImageSize(const ImageSize& size, const CameraModel& camera)
{
  expect(size.width == camera.width && size.height == camera.height, "is ", size.width, "x", size.height,
         " pixels, its camera has ", camera.width, "x", camera.height);
}

Image readImage(const std::string& path, const CameraModel& camera)
{
  return io::parseFile(path, [&](std::string_view bytes) {
    const ImageFormat& format = formatOf(bytes);
    requireImageSize(format.size(bytes), camera);
    return decodeImage(bytes);
  });
}

Image readPhotograph(const std::string& path, const CameraModel& camera)
{
  return io::parseFile(path, [&](std::string_view bytes) {
    const ImageFormat& format = formatOf(bytes);
    requireImageSize(sizeOf(bytes, format), camera);
    return format.decode == io::decodePng ? io::decodePngWithAlpha(bytes) : format.decode(bytes);
  });
}

Image16 readImage16(const std::string& path)
{
  return io::parseFile(path, [](std::string_view bytes) {
    const ImageFormat& format = formatOf(bytes);
    sizeOf(bytes, format);
    Image16 image = format.decode16 ? format.decode16(bytes) : Image16();
    expect(!image.data.empty(), "not a 16-bit image with one channel");
    return image;
  });
}

DepthFile readDepthFile(const std::string& path)
{
  const auto decode = [](std::string_view bytes) -> DepthFile {
    const ImageFormat& format = formatOf(bytes);
    sizeOf(bytes, format);
    DepthFile file;
    if (format.decode_floats) {
      const io::FloatImage metres = format.decode_floats(bytes);
      file.image = {metres.width, metres.height, {}};
      for (const float z : metres.data) {
        const double units = z / metres_unit;
        file.image.data.push_back(units >= 0 && units < 65535 ? std::uint16_t(units + 0.5) : 0);
      }
      file.in_metres = !file.image.data.empty();
    }
    if (!file.in_metres && format.decode16)
      file.image = format.decode16(bytes);
    expect(!file.image.data.empty(), "no depth image: wanted are 16 bits with one channel, or floats");
    return file;
  };
  return io::parseFile(path, decode);
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
  return extension == ".png" ? io::encodePng(image) : io::encodeJpeg(image, quality);
}

void writeImage(const std::string& path, const Image& image, int quality)
{
  write(path, encodeImage(image, extension(path), quality));
}

void writeImage(const std::string& path, const Image16& image)
{
  require(image.width > 0 && image.height > 0 && image.data.size() == std::size_t{1} * image.width * image.height &&
              extension(path) == ".png",
          "image: ", path, ": 16 bits are written as .png, from ", image.width, "x", image.height, " values");
  write(path, io::encodePng(image));
}
} // namespace fresco
