// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/files/expect.h"
#include <csetjmp>
#include <fresco/io/image_io.h>
/// One reader per format, of the bytes of a file that begins as its format wants. Sizes are those that the header tells,
/// 0 where it tells none. Readers give 8-bit RGB: of 16 bits the high byte, grey repeated, alpha left out, CMYK converted
/// without a colour profile, EXIF orientation not applied. All throw std::runtime_error if the file is damaged, truncated or not supported.
namespace fresco::io {
/// Rows from the top.
struct FloatImage {
  int width = 0, height = 0;
  std::vector<float> data;
};

ImageSize pngSize(std::string_view bytes);
Image decodePng(std::string_view bytes);
Image decodePngWithAlpha(std::string_view bytes); ///< RGBA if there is alpha
Image16 decodePng16(std::string_view bytes);

ImageSize jpegSize(std::string_view bytes);
Image decodeJpeg(std::string_view bytes); ///< a warning of the library is an error

/// Strips or tiles, 8 or 16 bits, grey, RGB or palette; not compressed, or by LZW, Deflate or PackBits.
ImageSize tiffSize(std::string_view bytes);
Image decodeTiff(std::string_view bytes);
Image16 decodeTiff16(std::string_view bytes);
FloatImage decodeTiffFloats(std::string_view bytes); ///< one channel of 32-bit floats; empty if it is another image

/// Portable float map of one channel (Pf), rows from below.
ImageSize pfmSize(std::string_view bytes);
FloatImage decodePfm(std::string_view bytes);

/// Array of NumPy, two-dimensional by rows, of 32 or 64-bit floats, the low byte first.
ImageSize npySize(std::string_view bytes);
FloatImage decodeNpy(std::string_view bytes);

/// Not compressed, 1 to 8 bits with a palette, 24 or 32.
ImageSize bmpSize(std::string_view bytes);
Image decodeBmp(std::string_view bytes);

ImageSize webpSize(std::string_view bytes);
Image decodeWebp(std::string_view bytes);

/// PNG (ISO/IEC 15948), without loss. Bands of rows are compressed in parallel, each in a chunk of its own.
/// @param image that is not empty
std::vector<std::uint8_t> encodePng(const Image& image);
std::vector<std::uint8_t> encodePng(const Image16& image);

/// @param quality 0..100
std::vector<std::uint8_t> encodeJpeg(const Image& image, int quality);

/// Where a library of C goes on after an error: it cannot be left by an exception.
struct LibraryErrors {
  std::jmp_buf place;
  char message[256] = "";
  [[noreturn]] void fail() { std::longjmp(place, 1); }
};

/// Calls of the library, which must not hold anything that a destructor frees.
/// @throws std::runtime_error with the library's words
template <typename Calls>
void callLibrary(LibraryErrors& errors, const Calls& calls)
{
  if (setjmp(errors.place) != 0)
    throw std::runtime_error(concat("the image is damaged: ", errors.message));
  calls();
}
} // namespace fresco::io
