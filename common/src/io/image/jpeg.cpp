// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/codecs.h"
#include <cstdio>
#include <cstdlib>
#include <jerror.h>
#include <jpeglib.h>
namespace fresco::io {
namespace {
/// Takes the library's errors; warnings, too, unless they say no more than that another program wrote the file.
struct ErrorHandler : jpeg_error_mgr {
  LibraryErrors errors;

  ErrorHandler()
  {
    jpeg_std_error(this);
    error_exit = fail;
    emit_message = [](j_common_ptr common, int level) {
      const int code = common->err->msg_code;
      if (level < 0 && code != JWRN_JFIF_MAJOR && code != JWRN_ADOBE_XFORM)
        fail(common);
    };
  }
  static void fail(j_common_ptr common)
  {
    auto& own = *static_cast<ErrorHandler*>(common->err);
    static_assert(sizeof(own.errors.message) >= JMSG_LENGTH_MAX);
    common->err->format_message(common, own.errors.message);
    own.errors.fail();
  }
};

/// A structure of the library, empty at first, that is destroyed whatever happens.
template <typename Struct, void (*destroy)(Struct*)>
struct Owned : Struct {
  explicit Owned(ErrorHandler& handler) : Struct{} { this->err = &handler; }
  ~Owned() { destroy(this); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
};

/// An open file, its header read.
struct JpegReader {
  ErrorHandler handler;
  Owned<jpeg_decompress_struct, jpeg_destroy_decompress> jpeg{handler};

  explicit JpegReader(std::string_view bytes)
  {
    callLibrary(handler.errors, [&] {
      jpeg_create_decompress(&jpeg);
      jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
      jpeg_read_header(&jpeg, TRUE);
    });
  }
  ImageSize size() const { return {int(jpeg.image_width), int(jpeg.image_height)}; }
};

struct JpegBytes {
  unsigned char* begin = nullptr;
  unsigned long size = 0;
  ~JpegBytes() { std::free(begin); }
};

/// One row of CMYK. @param no_ink 255 as Adobe's programs store it, who leave their marker in the file, else 0
void toRgb(const std::uint8_t* cmyk, std::uint8_t* rgb, int width, int no_ink)
{
  const auto left = [&](std::uint8_t ink) { return 255 - std::abs(ink - no_ink); };
  for (int x = 0; x < width; ++x)
    for (int c = 0; c < 3; ++c)
      rgb[3 * x + c] = static_cast<std::uint8_t>(left(cmyk[4 * x + c]) * left(cmyk[4 * x + 3]) / 255);
}
} // namespace

ImageSize jpegSize(std::string_view bytes) { return JpegReader(bytes).size(); }

Image decodeJpeg(std::string_view bytes)
{
  JpegReader reader(bytes);
  jpeg_decompress_struct& jpeg = reader.jpeg;
  const bool is_cmyk = jpeg.num_components == 4;
  Image image(reader.size().width, reader.size().height, 3);
  std::vector<std::uint8_t> cmyk(is_cmyk ? std::size_t{4} * jpeg.image_width : 0);
  callLibrary(reader.handler.errors, [&] {
    jpeg.out_color_space = is_cmyk ? JCS_CMYK : JCS_RGB;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
      std::uint8_t* const target = image.pixel(0, static_cast<int>(jpeg.output_scanline));
      JSAMPROW row = is_cmyk ? cmyk.data() : target;
      jpeg_read_scanlines(&jpeg, &row, 1);
      if (is_cmyk)
        toRgb(cmyk.data(), target, image.width, jpeg.saw_Adobe_marker ? 255 : 0);
    }
    jpeg_finish_decompress(&jpeg);
  });
  return image;
}

std::vector<std::uint8_t> encodeJpeg(const Image& image, int quality)
{
  ErrorHandler handler;
  JpegBytes bytes;
  Owned<jpeg_compress_struct, jpeg_destroy_compress> jpeg(handler);
  callLibrary(handler.errors, [&] {
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes.begin, &bytes.size);
    jpeg.image_width = image.width;
    jpeg.image_height = image.height;
    jpeg.input_components = image.channels;
    jpeg.in_color_space = image.channels == 1 ? JCS_GRAYSCALE : image.channels == 3 ? JCS_RGB : JCS_EXT_RGBX;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, quality, TRUE);
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
      JSAMPROW row = const_cast<std::uint8_t*>(image.pixel(0, static_cast<int>(jpeg.next_scanline)));
      jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
  });
  return {bytes.begin, bytes.begin + bytes.size};
}
} // namespace fresco::io
