// SPDX-License-Identifier: BSD-3-Clause
// Baseline TIFF 6.0 (Adobe 1992) and its compressions that every program writes. Debian's libtiff links a GPL library.
#include "io/image/codecs.h"
#include "io/image/header_numbers.h"
#include <algorithm>
#include <cstring>
#include <zlib.h>
namespace fresco::io {
namespace {
using Tag = std::uint32_t;
constexpr Tag width_tag = 256, height_tag = 257, bits_tag = 258, compression_tag = 259, photometric_tag = 262,
              strip_offsets_tag = 273, samples_tag = 277, rows_per_strip_tag = 278, strip_bytes_tag = 279,
              planar_tag = 284, predictor_tag = 317, palette_tag = 320, tile_width_tag = 322, tile_height_tag = 323,
              tile_offsets_tag = 324, tile_bytes_tag = 325, sample_format_tag = 339;
constexpr std::uint32_t plain = 1, lzw = 5, deflate = 8, old_deflate = 32946, pack_bits = 32773; // compressions
constexpr std::uint32_t white_is_zero = 0, black_is_zero = 1, rgb = 2, palette_colors = 3;       // photometrics

[[noreturn]] void failDamaged() { throw std::runtime_error("the image is truncated or damaged"); }

/// The first table of a file.
class Table {
public:
  explicit Table(std::string_view bytes) : file_{bytes, bytes[0] == 'I'}, begin_(file_.number(4, 4)) {}
  const HeaderNumbers& file() const { return file_; }

  /// @return `otherwise` if there is no such value
  std::uint32_t value(Tag tag, std::uint32_t otherwise, std::size_t index = 0) const
  {
    constexpr std::uint32_t byte_type = 1, short_type = 3;
    const std::uint32_t entries = file_.number(begin_, 2);
    for (std::uint32_t i = 0; i < entries && begin_ + std::size_t{12} * i < file_.bytes.size(); ++i) {
      const std::size_t entry = begin_ + 2 + std::size_t{12} * i;
      if (file_.number(entry, 2) != tag)
        continue;
      const std::uint32_t type = file_.number(entry + 2, 2), count = file_.number(entry + 4, 4);
      const std::size_t size = type == byte_type ? 1 : type == short_type ? 2 : 4;
      const std::size_t at = size * count <= 4 ? entry + 8 : file_.number(entry + 8, 4);
      return index < count ? file_.number(at + size * index, size) : otherwise;
    }
    return otherwise;
  }

private:
  HeaderNumbers file_;
  std::size_t begin_;
};

/// Codes of 9 to 12 bits, the high bit first, which grow one code early (TIFF 6.0, section 13).
class LzwUnpacker {
public:
  std::string unpack(std::string_view packed, std::size_t size)
  {
    std::uint32_t bits = 0, held = 0;
    for (const unsigned char byte : packed) {
      bits = bits << 8 | byte;
      held += 8;
      while (held >= width_ && out_.size() < size) {
        held -= width_;
        if (!take(bits >> held & ((1U << width_) - 1)))
          return std::move(out_);
      }
    }
    return std::move(out_);
  }

private:
  static constexpr std::uint32_t clear = 256, end = 257, most_words = 4096;
  struct Word {
    std::size_t begin, length; ///< in what is unpacked
  };

  /// @return false at the end
  bool take(std::uint32_t code)
  {
    if (code == end)
      return false;
    const std::size_t begin = out_.size();
    if (code == clear) {
      words_.resize(end + 1);
    } else {
      if (previous_ != clear && words_.size() < most_words) // the word before and the first letter of this one
        words_.push_back({previous_begin_, begin - previous_begin_ + 1});
      if (code >= words_.size())
        failDamaged();
      if (code < clear)
        out_ += static_cast<char>(code);
      for (std::size_t i = 0; i < words_[code].length; ++i) // the last letter may be the first of these
        out_ += out_[words_[code].begin + i];
    }
    previous_ = code;
    previous_begin_ = begin;
    width_ = words_.size() >= 2047 ? 12 : words_.size() >= 1023 ? 11 : words_.size() >= 511 ? 10 : 9;
    return true;
  }

  std::string out_;
  std::vector<Word> words_ = std::vector<Word>(end + 1, Word{0, 0});
  std::uint32_t width_ = 9, previous_ = clear;
  std::size_t previous_begin_ = 0;
};

/// A count and that many bytes, or a negative count and one byte to be repeated (TIFF 6.0, section 9).
std::string unpackBits(std::string_view packed, std::size_t size)
{
  std::string out;
  for (std::size_t at = 0; at + 1 < packed.size() && out.size() < size;) {
    const int count = static_cast<signed char>(packed[at++]);
    if (count >= 0)
      out += packed.substr(at, count + 1);
    else if (count > -128)
      out.append(1 - count, packed[at]);
    at += count >= 0 ? count + 1 : count > -128 ? 1 : 0;
  }
  return out;
}

std::string unpack(std::string_view packed, std::uint32_t compression, std::size_t size)
{
  std::string out;
  if (compression == lzw) {
    out = LzwUnpacker().unpack(packed, size);
  } else if (compression == pack_bits) {
    out = unpackBits(packed, size);
  } else if (compression == deflate || compression == old_deflate) {
    uLongf length = size;
    out.resize(size);
    if (uncompress(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<const Bytef*>(packed.data()),
                   packed.size()) != Z_OK)
      failDamaged();
    out.resize(length);
  } else {
    out = packed.substr(0, size);
  }
  if (out.size() < size)
    failDamaged();
  return out;
}

constexpr std::size_t best_ratio = 1400; // of any of the compressions: LZW packs 8 MB of one value into 6 kB

/// How the samples of an image lie in its file: in strips or tiles.
struct Layout {
  std::uint32_t width, height, bits, samples, photometric, compression, predictor;
  bool apart, tiled; ///< each sample in strips of its own
  std::uint32_t part_width, part_height;
};

Layout layoutOf(const Table& table)
{
  Layout out{};
  out.width = table.value(width_tag, 0);
  out.height = table.value(height_tag, 0);
  out.bits = table.value(bits_tag, 1);
  out.samples = table.value(samples_tag, 1);
  out.photometric = table.value(photometric_tag, black_is_zero);
  out.compression = table.value(compression_tag, plain);
  out.predictor = table.value(predictor_tag, 1);
  out.apart = table.value(planar_tag, 1) == 2 && out.samples > 1;
  out.tiled = table.value(tile_offsets_tag, 0) > 0;
  out.part_width = out.tiled ? table.value(tile_width_tag, 0) : out.width;
  out.part_height =
      out.tiled ? table.value(tile_height_tag, 0) : std::min(table.value(rows_per_strip_tag, out.height), out.height);
  const auto known = {plain, lzw, deflate, old_deflate, pack_bits};
  constexpr std::uint32_t whole = 1, floating = 3; // formats of a sample
  const std::uint32_t format = table.value(sample_format_tag, whole);
  const bool is_picture = format == whole && (out.bits == 8 || out.bits == 16) && out.predictor <= 2;
  const bool is_depth = format == floating && out.bits == 32 && out.samples == 1 && out.photometric <= black_is_zero;
  const bool is_known = std::count(known.begin(), known.end(), out.compression) > 0 &&
                        out.photometric <= palette_colors && (is_picture || (is_depth && out.predictor <= 3));
  expect(is_known, "TIFF: compression ", out.compression, ", ", out.bits, " bits, photometric ", out.photometric,
         " is not supported: save the image as PNG");
  constexpr std::uint32_t longest = 1 << 20; // pixels
  const auto is_possible = [](std::uint32_t length) { return length > 0 && length <= longest; };
  if (!is_possible(out.width) || !is_possible(out.height) || !is_possible(out.part_width) ||
      !is_possible(out.part_height) || out.samples < (out.photometric == rgb ? 3U : 1U) || out.samples > 16 ||
      std::uint64_t{out.width} * out.height * out.samples * (out.bits / 8) > best_ratio * table.file().bytes.size())
    failDamaged();
  return out;
}

/// Undoes the prediction of floats (Adobe Photoshop TIFF Technical Note 3): the first bytes of all pixels of a row, the high ones, then the
/// second ones ..., each as the difference from the byte before.
std::string withoutFloatPrediction(const std::string& raw, std::size_t row, bool low_first)
{
  std::string out(raw.size(), '\0');
  for (std::size_t begin = 0; begin + 4 * row <= raw.size(); begin += 4 * row) {
    char byte = 0;
    for (std::size_t i = 0; i < 4 * row; ++i) {
      byte = static_cast<char>(byte + raw[begin + i]);
      const std::size_t place = i / row;
      out[begin + 4 * (i % row) + (low_first ? 3 - place : place)] = byte;
    }
  }
  return out;
}

/// Samples of the part `index` in the order of pixels, native and without prediction.
template <typename Sample>
std::vector<Sample> samplesOf(const Table& table, const Layout& layout, std::size_t index, std::uint32_t rows)
{
  const std::size_t step = layout.apart ? 1 : layout.samples, row = step * layout.part_width, bytes = layout.bits / 8;
  const std::size_t begin = table.value(layout.tiled ? tile_offsets_tag : strip_offsets_tag, 0, index);
  const std::size_t size = table.value(layout.tiled ? tile_bytes_tag : strip_bytes_tag, 0, index);
  const std::string_view file = table.file().bytes;
  if (begin >= file.size() || size > file.size() - begin || row * rows * bytes > best_ratio * size)
    failDamaged();
  std::string raw = unpack(file.substr(begin, size), layout.compression, row * rows * bytes);
  if (layout.predictor == 3)
    raw = withoutFloatPrediction(raw, row, table.file().low_first);
  const HeaderNumbers numbers{raw, table.file().low_first};
  std::vector<Sample> samples(row * rows);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = numbers.number(i * bytes, bytes);
    if (layout.predictor == 2 && i % row >= step)
      samples[i] += samples[i - step];
    if (layout.bits == 8)
      samples[i] &= 0xff;
  }
  return samples;
}

/// put(x, y, sample, value) of every sample of a file.
template <typename Sample, typename Put>
void forEachSample(const Table& table, const Layout& layout, const Put& put)
{
  const std::uint32_t across = (layout.width + layout.part_width - 1) / layout.part_width;
  const std::uint32_t down = (layout.height + layout.part_height - 1) / layout.part_height;
  const std::uint32_t planes = layout.apart ? layout.samples : 1, step = layout.apart ? 1 : layout.samples;
  for (std::size_t part = 0; part < std::size_t{1} * across * down * planes; ++part) {
    const std::uint32_t x0 = part % across * layout.part_width, y0 = part / across % down * layout.part_height;
    const std::uint32_t shown = std::min(layout.part_height, layout.height - y0);
    const auto samples = samplesOf<Sample>(table, layout, part, layout.tiled ? layout.part_height : shown);
    for (std::uint32_t y = 0; y < shown; ++y)
      for (std::uint32_t x = 0; x < layout.part_width && x0 + x < layout.width; ++x)
        for (std::uint32_t s = 0; s < step; ++s)
          put(x0 + x, y0 + y, s + part / across / down, samples[(std::size_t{y} * layout.part_width + x) * step + s]);
  }
}

/// An image of one channel, of samples as its values are stored.
template <typename Sample, typename Picture>
Picture onlyChannel(const Table& table, const Layout& layout)
{
  Picture image{int(layout.width), int(layout.height), {}};
  image.data.resize(std::size_t{layout.width} * layout.height);
  forEachSample<Sample>(table, layout, [&](std::uint32_t x, std::uint32_t y, std::uint32_t, Sample value) {
    std::memcpy(&image.data[std::size_t{y} * layout.width + x], &value, sizeof value);
  });
  return image;
}
} // namespace

ImageSize tiffSize(std::string_view bytes)
{
  const Table table(bytes);
  constexpr std::uint32_t most = 0x7fffffff;
  return {int(std::min(table.value(width_tag, 0), most)), int(std::min(table.value(height_tag, 0), most))};
}

Image decodeTiff(std::string_view bytes)
{
  const Table table(bytes);
  const Layout layout = layoutOf(table);
  expect(layout.bits != 32, "TIFF: holds depths (floats), no picture");
  Image image(layout.width, layout.height, 3);
  const std::size_t colors = std::size_t{1} << layout.bits;
  const auto put = [&](std::uint32_t x, std::uint32_t y, std::uint32_t sample, std::uint32_t value) {
    std::uint8_t* const pixel = image.pixel(x, y);
    const std::uint8_t byte = value >> (layout.bits - 8);
    if (layout.photometric == rgb && sample < 3)
      pixel[sample] = byte;
    else if (layout.photometric != rgb && sample == 0)
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = layout.photometric == palette_colors  ? table.value(palette_tag, 0, c * colors + value) >> 8
                   : layout.photometric == white_is_zero ? 255 - byte
                                                         : byte;
  };
  forEachSample<std::uint16_t>(table, layout, put);
  return image;
}

Image16 decodeTiff16(std::string_view bytes)
{
  const Table table(bytes);
  const Layout layout = layoutOf(table);
  if (layout.bits != 16 || layout.samples != 1 || layout.photometric != black_is_zero)
    return {};
  return onlyChannel<std::uint16_t, Image16>(table, layout);
}

FloatImage decodeTiffFloats(std::string_view bytes)
{
  const Table table(bytes);
  const Layout layout = layoutOf(table);
  return layout.bits == 32 ? onlyChannel<std::uint32_t, FloatImage>(table, layout) : FloatImage();
}
} // namespace fresco::io
