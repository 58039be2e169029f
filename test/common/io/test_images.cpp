// SPDX-License-Identifier: BSD-3-Clause
// Files that other programs write, made here from known pixels: every kind of sample gives the same pixels again.
#include "common/io/image_samples.h"
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fresco/core/camera.h>
#include <fresco/core/require.h>
#include <jpeglib.h>
#include <map>
#include <png.h>
#include <webp/encode.h>
namespace {
using namespace fresco;
using namespace fresco::test::images;

/// PNG by libpng. @param transparent_value that of the first pixel
void putPng(const std::string& path, const Samples& samples, int type, int interlace, bool transparent_value = false)
{
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto append = [](png_structp p, png_bytep data, std::size_t count) {
    static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<const char*>(data), count);
  };
  png_set_write_fn(png, &bytes, append, [](png_structp) {});
  png_set_IHDR(png, info, width, height, samples.bits, type, interlace, 0, 0);
  std::vector<png_color> palette(std::size_t{1} << std::min(samples.bits, 8));
  for (std::size_t i = 0; i < palette.size(); ++i)
    palette[i] = {paletteColor(i)[0], paletteColor(i)[1], paletteColor(i)[2]};
  if (type == PNG_COLOR_TYPE_PALETTE) {
    png_set_PLTE(png, info, palette.data(), palette.size());
    const std::uint8_t transparent = 0; // alpha is left out
    png_set_tRNS(png, info, &transparent, 1, nullptr);
  }
  if (transparent_value) {
    png_color_16 value{};
    const auto first = [&](int c) { return png_uint_16(samples.at(0, 0, c)); };
    if (samples.channels == 1)
      value.gray = first(0);
    else
      value.red = first(0), value.green = first(1), value.blue = first(2);
    png_set_tRNS(png, info, nullptr, 0, &value);
  }
  png_write_info(png, info);
  if (samples.bits < 8)
    png_set_packing(png);
  std::vector<std::vector<std::uint8_t>> rows(height);
  std::vector<std::uint8_t*> begins;
  for (int y = 0; y < height; ++y) {
    for (int i = 0; i < width * samples.channels; ++i) {
      const std::uint32_t value = samples.at(i / samples.channels, y, i % samples.channels);
      if (samples.bits == 16)
        rows[y].push_back(value >> 8);
      rows[y].push_back(value & 255);
    }
    begins.push_back(rows[y].data());
  }
  png_write_image(png, begins.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  writeFile(path, bytes);
}

TEST(Images, EveryKindOfPng)
{
  const std::string path = test::scratchFolder() + "/a.png";
  const std::map<int, int> channels = {{PNG_COLOR_TYPE_GRAY, 1},
                                       {PNG_COLOR_TYPE_GRAY_ALPHA, 2},
                                       {PNG_COLOR_TYPE_RGB, 3},
                                       {PNG_COLOR_TYPE_RGB_ALPHA, 4},
                                       {PNG_COLOR_TYPE_PALETTE, 1}};
  for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7})
    for (const auto& [type, count] : channels)
      for (const int bits : {1, 2, 4, 8, 16}) {
        if ((bits < 8 && count > 1) || (bits == 16 && type == PNG_COLOR_TYPE_PALETTE))
          continue;
        SCOPED_TRACE(concat("type ", type, ", ", bits, " bits, interlace ", interlace));
        const Samples samples(count, bits);
        putPng(path, samples, type, interlace);
        expectColors(path, [&, type = type, count = count](int x, int y, int c) -> int {
          const std::uint32_t value = samples.at(x, y, count < 3 ? 0 : c);
          if (type == PNG_COLOR_TYPE_PALETTE)
            return paletteColor(value)[c];
          return bits == 16 ? value >> 8 : value * 255 / ((1U << bits) - 1);
        });
        if (type == PNG_COLOR_TYPE_GRAY && bits == 16) {
          EXPECT_TRUE(std::equal(samples.values.begin(), samples.values.end(), readImage16(path).data.begin()));
        } else {
          EXPECT_THROW(readImage16(path), std::runtime_error);
        }
      }
}

TEST(Images, SixteenBitsRoundTrip)
{
  const std::string path = test::scratchFolder() + "/a.png";
  const Samples samples(1, 16);
  const Image16 image{width, height, {samples.values.begin(), samples.values.end()}};
  writeImage(path, image);
  EXPECT_EQ(readImage16(path).data, image.data);
  EXPECT_EQ(readImage16(path).width, width);
  EXPECT_THROW(writeImage(path + ".jpg", image), std::invalid_argument);
  EXPECT_THROW(writeImage(path, Image16{2, 2, {1, 2, 3}}), std::invalid_argument);
}

TEST(Images, WebpAndBmp)
{
  const std::string folder = test::scratchFolder();
  const Samples samples(3, 8), indices(1, 8);
  std::vector<std::uint8_t> rgb(samples.values.begin(), samples.values.end());
  std::uint8_t* bytes = nullptr;
  const std::size_t size = WebPEncodeLosslessRGB(rgb.data(), width, height, 3 * width, &bytes);
  const std::string webp(reinterpret_cast<const char*>(bytes), size);
  WebPFree(bytes);
  writeFile(folder + "/a.webp", webp);
  expectColors(folder + "/a.webp", [&](int x, int y, int c) { return int(samples.at(x, y, c)); });
  writeFile(folder + "/cut.webp", webp.substr(0, size / 2));
  EXPECT_THROW(readImage(folder + "/cut.webp"), std::runtime_error);

  const auto raw = [](auto value) { return std::string(reinterpret_cast<const char*>(&value), sizeof(value)); };
  for (const bool from_top : {false, true})
    for (const std::uint16_t bits : {8, 24, 32}) {
      std::string palette, pixels;
      for (std::uint32_t i = 0; bits == 8 && i < 256; ++i)
        palette += {char(paletteColor(i)[2]), char(paletteColor(i)[1]), char(paletteColor(i)[0]), 0};
      for (int row = 0; row < height; ++row) {
        const int y = from_top ? row : height - 1 - row;
        for (int x = 0; x < width; ++x)
          if (bits == 8)
            pixels += static_cast<char>(indices.at(x, y, 0));
          else
            for (int c = 2; c >= 0 - (bits == 32); --c)
              pixels += c < 0 ? '\x7f' : static_cast<char>(samples.at(x, y, c));
        pixels.resize((pixels.size() + 3) / 4 * 4);
      }
      const std::int32_t shown = from_top ? -height : height;
      const std::uint32_t first = 54 + palette.size(), all = first + pixels.size();
      const std::string file = "BM" + raw(all) + raw(0) + raw(first) + raw(40) + raw(width) + raw(shown) +
                               raw(std::uint16_t{1}) + raw(bits) + std::string(24, '\0') + palette + pixels;
      writeFile(folder + "/a.bmp", file);
      expectColors(folder + "/a.bmp", [&](int x, int y, int c) -> int {
        return bits == 8 ? paletteColor(indices.at(x, y, 0))[c] : samples.at(x, y, c);
      });
      writeFile(folder + "/cut.bmp", file.substr(0, file.size() - 4));
      EXPECT_THROW(readImage(folder + "/cut.bmp"), std::runtime_error);
    }
}

/// Grey or colours of which one value is transparent.
TEST(Images, OneTransparentValueIsAlphaOfAPhotographAndLeftOutElsewhere)
{
  const std::string path = test::scratchFolder() + "/a.png";
  const CameraModel camera{width, height, 50, 50, 26, 20, 0, 0, 0, 0};
  for (const auto& [type, count] : std::map<int, int>{{PNG_COLOR_TYPE_GRAY, 1}, {PNG_COLOR_TYPE_RGB, 3}})
    for (const int bits : {8, 16}) {
      const Samples samples(count, bits);
      putPng(path, samples, type, PNG_INTERLACE_NONE, true);
      const auto expected = [&, count = count](int x, int y, int c) {
        return int(samples.at(x, y, count < 3 ? 0 : c) >> (bits - 8));
      };
      expectColors(path, expected);
      const Image image = readPhotograph(path, camera);
      ASSERT_EQ(image.channels, 4);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          bool first = true; // the value of the first pixel is the transparent one
          for (int c = 0; c < count; ++c)
            first = first && samples.at(x, y, c) == samples.at(0, 0, c);
          ASSERT_EQ(image.pixel(x, y)[3], first ? 0 : 255) << type << " " << bits;
          for (int c = 0; c < 3; ++c)
            ASSERT_EQ(image.pixel(x, y)[c], expected(x, y, c));
        }
    }
}

/// JPEG of one colour, by libjpeg. @param ink cyan, magenta, yellow, black @param adobe stores what is left without ink
std::string cmykJpeg(const std::array<std::uint8_t, 4>& ink, J_COLOR_SPACE stored, bool adobe)
{
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = width, jpeg.image_height = height, jpeg.input_components = 4, jpeg.in_color_space = JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_colorspace(&jpeg, stored);
  jpeg_set_quality(&jpeg, 100, TRUE);
  jpeg.write_Adobe_marker = adobe ? TRUE : FALSE;
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<std::uint8_t> row;
  for (int i = 0; i < 4 * width; ++i)
    row.push_back(adobe ? 255 - ink[i % 4] : ink[i % 4]);
  for (JSAMPROW rows = row.data(); jpeg.next_scanline < jpeg.image_height;)
    jpeg_write_scanlines(&jpeg, &rows, 1);
  jpeg_finish_compress(&jpeg);
  std::string file(reinterpret_cast<const char*>(bytes), size);
  jpeg_destroy_compress(&jpeg);
  std::free(bytes);
  return file;
}

/// Adobe's programs store ink inverted, and say so by their marker; others do not.
TEST(Images, InkOfJpegBecomesColors)
{
  const std::string path = test::scratchFolder() + "/a.jpg";
  for (const auto& [stored, adobe] : {std::pair(JCS_CMYK, true), {JCS_CMYK, false}, {JCS_YCCK, true}})
    for (const std::array<std::uint8_t, 4> ink :
         {std::array<std::uint8_t, 4>{0, 0, 0, 0}, {255, 40, 0, 0}, {30, 200, 90, 60}}) {
      writeFile(path, cmykJpeg(ink, stored, adobe));
      const Image image = readImage(path);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(image.pixel(20, 20)[c], (255 - ink[c]) * (255 - ink[3]) / 255.0, 3) << stored << adobe;
    }
}

TEST(Images, AnotherSizeThanTheCameraIsRefusedBeforeDecoding)
{
  const std::string path = test::scratchFolder() + "/a.png";
  putPng(path, Samples(3, 8), PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE);
  CameraModel camera{width, height, 50, 50, 26, 20, 0, 0, 0, 0};
  EXPECT_EQ(readImage(path, camera).data, readImage(path).data);
  std::string bytes = readFile(path);
  bytes.replace(bytes.find("IDAT") + 4, 8, "damaged!");
  writeFile(path, bytes);
  EXPECT_NE(test::errorOf([&] { readImage(path, camera); }).find("damaged"), std::string::npos);
  camera.width = 64;
  const std::string error = test::errorOf([&] { readImage(path, camera); });
  EXPECT_NE(error.find("a.png: is 53x41 pixels, its camera has 64x41"), std::string::npos) << error;
}
} // namespace
