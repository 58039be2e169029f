// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/jpeg_reader.h"
#include <csetjmp>
#include <cstdio>
#include <fresco/core/require.h>
#include <jerror.h>
#include <jpeglib.h>
namespace fresco::io {
namespace {
/// The library's state, and where it goes on after an error: it is C and cannot be left by an exception.
struct Decoder {
  jpeg_decompress_struct jpeg;
  jpeg_error_mgr handler;
  std::jmp_buf after_error;
  char message[JMSG_LENGTH_MAX];

  Decoder()
  {
    jpeg.err = jpeg_std_error(&handler);
    jpeg.client_data = this;
    handler.error_exit = fail;
    handler.emit_message = [](j_common_ptr common, int level) {
      // Both say no more than that another program wrote the file.
      const int code = common->err->msg_code;
      if (level < 0 && code != JWRN_JFIF_MAJOR && code != JWRN_ADOBE_XFORM)
        fail(common);
    };
  }
  [[noreturn]] static void fail(j_common_ptr common)
  {
    auto& own = *static_cast<Decoder*>(common->client_data);
    common->err->format_message(common, own.message);
    std::longjmp(own.after_error, 1);
  }
};

/// Calls of the library, which must not hold anything that a destructor frees. @return false after an error
template <typename Calls>
bool succeeds(Decoder& decoder, const Calls& calls)
{
  if (setjmp(decoder.after_error) != 0)
    return false;
  calls(decoder.jpeg);
  return true;
}

/// Frees what the library holds, also when an exception passes.
struct Cleanup {
  Decoder& decoder;
  ~Cleanup() { jpeg_destroy_decompress(&decoder.jpeg); }
};

void check(bool ok, const Decoder& decoder)
{
  if (!ok)
    throw std::runtime_error(concat("the image is damaged: ", decoder.message));
}

/// One row of CMYK as Adobe's programs store it, 255 = no ink.
void toRgb(const std::uint8_t* cmyk, std::uint8_t* rgb, int width)
{
  for (int x = 0; x < width; ++x)
    for (int c = 0; c < 3; ++c)
      rgb[3 * x + c] = static_cast<std::uint8_t>(cmyk[4 * x + c] * cmyk[4 * x + 3] / 255);
}
} // namespace

Image decodeJpeg(std::string_view bytes)
{
  Decoder decoder;
  jpeg_decompress_struct& jpeg = decoder.jpeg;
  check(succeeds(decoder, [](jpeg_decompress_struct& j) { jpeg_create_decompress(&j); }), decoder);
  const Cleanup cleanup{decoder};
  const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
  const auto size = static_cast<unsigned long>(bytes.size());
  check(succeeds(decoder,
                 [&](jpeg_decompress_struct& j) {
                   jpeg_mem_src(&j, begin, size);
                   jpeg_read_header(&j, TRUE);
                 }),
        decoder);
  constexpr std::size_t most_pixels_per_byte = 512; // a block of 64 pixels takes a bit at least
  if (std::size_t{jpeg.image_width} * jpeg.image_height > most_pixels_per_byte * bytes.size())
    throw std::runtime_error(concat("the image is damaged: ", jpeg.image_width, "x", jpeg.image_height,
                                    " pixels do not fit into ", bytes.size(), " bytes"));
  const bool is_cmyk = jpeg.num_components == 4;
  Image image(static_cast<int>(jpeg.image_width), static_cast<int>(jpeg.image_height), 3);
  std::vector<std::uint8_t> cmyk(is_cmyk ? std::size_t{4} * jpeg.image_width : 0);
  check(succeeds(decoder,
                 [&](jpeg_decompress_struct& j) {
                   j.out_color_space = is_cmyk ? JCS_CMYK : JCS_RGB;
                   jpeg_start_decompress(&j);
                   while (j.output_scanline < j.output_height) {
                     std::uint8_t* const target = image.pixel(0, static_cast<int>(j.output_scanline));
                     JSAMPROW row = is_cmyk ? cmyk.data() : target;
                     jpeg_read_scanlines(&j, &row, 1);
                     if (is_cmyk)
                       toRgb(cmyk.data(), target, image.width);
                   }
                   jpeg_finish_decompress(&j);
                 }),
        decoder);
  return image;
}
} // namespace fresco::io
