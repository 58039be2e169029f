// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/codecs.h"
#include <cstring>
#include <png.h>
namespace fresco::io {
namespace {
/// An open file, its header read.
class PngReader {
public:
  explicit PngReader(std::string_view bytes) : PngReader() // so that errors from here on end in the destructor, too
  {
    rest_ = bytes;
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &errors_, fail, ignore);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_)
      throw std::bad_alloc();
    png_set_read_fn(png_, this, take);
    callLibrary(errors_, [&] { png_read_info(png_, info_); });
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  ImageSize size() const { return {int(png_get_image_width(png_, info_)), int(png_get_image_height(png_, info_))}; }
  bool isGrey16() const
  {
    return png_get_bit_depth(png_, info_) == 16 && png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY;
  }

  bool hasAlpha() const
  {
    return png_get_color_type(png_, info_) & PNG_COLOR_MASK_ALPHA || png_get_valid(png_, info_, PNG_INFO_tRNS);
  }

  /// @param with_alpha RGBA if there is alpha
  Image read(bool with_alpha)
  {
    Image image(size().width, size().height, with_alpha && hasAlpha() ? 4 : 3);
    callLibrary(errors_, [&] {
      png_set_strip_16(png_);
      png_set_palette_to_rgb(png_);
      if (png_get_bit_depth(png_, info_) < 8 && png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY)
        png_set_expand_gray_1_2_4_to_8(png_);
      png_set_gray_to_rgb(png_);
      if (!with_alpha)
        png_set_strip_alpha(png_);
      else if (png_get_valid(png_, info_, PNG_INFO_tRNS))
        png_set_tRNS_to_alpha(png_);
      readRows(image.data.data());
    });
    return image;
  }
  void readGrey16(std::uint16_t* rows)
  {
    callLibrary(errors_, [&] {
      png_set_swap(png_);
      readRows(reinterpret_cast<std::uint8_t*>(rows));
    });
  }

private:
  PngReader() = default;
  static void fail(png_structp png, png_const_charp reason)
  {
    auto& errors = *static_cast<LibraryErrors*>(png_get_error_ptr(png));
    std::strncpy(errors.message, reason, sizeof(errors.message) - 1);
    errors.fail();
  }
  static void ignore(png_structp, png_const_charp) {} // what libpng warns of does not change pixels
  static void take(png_structp png, png_bytep target, std::size_t count)
  {
    std::string_view& rest = static_cast<PngReader*>(png_get_io_ptr(png))->rest_;
    if (count > rest.size())
      png_error(png, "truncated");
    std::memcpy(target, rest.data(), count);
    rest.remove_prefix(count);
  }
  void readRows(std::uint8_t* rows)
  {
    const int passes = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    const std::size_t stride = png_get_rowbytes(png_, info_);
    for (int pass = 0; pass < passes; ++pass)
      for (int y = 0; y < size().height; ++y)
        png_read_row(png_, rows + y * stride, nullptr);
    png_read_end(png_, nullptr);
  }

  std::string_view rest_;
  LibraryErrors errors_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};
} // namespace

ImageSize pngSize(std::string_view bytes) { return PngReader(bytes).size(); }

Image decodePng(std::string_view bytes) { return PngReader(bytes).read(false); }

Image decodePngWithAlpha(std::string_view bytes) { return PngReader(bytes).read(true); }

Image16 decodePng16(std::string_view bytes)
{
  PngReader reader(bytes);
  if (!reader.isGrey16())
    return {};
  const auto [width, height] = reader.size();
  Image16 image{width, height, std::vector<std::uint16_t>(std::size_t{1} * width * height)};
  reader.readGrey16(image.data.data());
  return image;
}
} // namespace fresco::io
