// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/codecs.h"
#include <algorithm>
#include <cstdlib>
#include <fresco/core/parallel.h>
#include <new>
#include <string_view>
#include <zlib.h>
namespace fresco::io {
namespace {
using Bytes = std::vector<std::uint8_t>;

void appendNumber(std::uint32_t number, Bytes& out)
{
  for (const int shift : {24, 16, 8, 0})
    out.push_back(number >> shift);
}

void appendChunk(std::string_view type, const Bytes& data, Bytes& out)
{
  appendNumber(data.size(), out);
  const std::size_t begin = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  appendNumber(crc32_z(0, out.data() + begin, out.size() - begin), out);
}

/// Bytes less their prediction from those to the left and above (filter 4, Paeth 1991).
/// @param above row above, zeros for the first one
void appendRow(const std::uint8_t* row, const std::uint8_t* above, const Image& image, Bytes& out)
{
  const int n = image.width * image.channels, left = image.channels;
  out.push_back(4);
  out.resize(out.size() + n);
  std::uint8_t* to = out.data() + out.size() - n;
  for (int i = 0; i < left; ++i)
    to[i] = row[i] - above[i];
  for (int i = left; i < n; ++i) {
    const std::int16_t a = row[i - left], b = above[i], c = above[i - left];
    const std::int16_t to_a = std::abs(b - c), to_b = std::abs(a - c), to_c = std::abs(a + b - 2 * c);
    const std::int16_t other = to_b <= to_c ? b : c;
    to[i] = row[i] - (to_a <= std::min(to_b, to_c) ? a : other);
  }
}

struct Band {
  Bytes data; ///< compressed
  std::size_t length = 0;
  std::uint32_t check = 0; ///< Adler-32 of what is compressed
};

/// @param bytes of a stream, of which these are the last ones or not
Band compressed(const Bytes& bytes, bool last)
{
  // With runs for matches: rows of a photograph, once filtered, repeat little else.
  constexpr int fastest = 1, without_header = -15, most_memory = 9;
  z_stream stream{};
  if (deflateInit2(&stream, fastest, Z_DEFLATED, without_header, most_memory, Z_RLE) != Z_OK)
    throw std::bad_alloc();
  constexpr std::size_t flush_bytes = 16; // which the bound leaves out
  Band out{Bytes(deflateBound(&stream, bytes.size()) + flush_bytes), bytes.size(), 0};
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = bytes.size();
  stream.next_out = out.data.data();
  stream.avail_out = out.data.size();
  deflate(&stream, last ? Z_FINISH : Z_SYNC_FLUSH);
  out.data.resize(stream.total_out);
  out.data.shrink_to_fit();
  deflateEnd(&stream);
  out.check = adler32_z(1, bytes.data(), bytes.size());
  return out;
}

/// In bands of about a megabyte.
std::vector<Band> compressedRows(const Image& image)
{
  constexpr std::size_t band_bytes = 1 << 20;
  const std::size_t row_bytes = std::size_t{1} * image.width * image.channels;
  const int rows = std::max<std::size_t>(1, band_bytes / row_bytes);
  std::vector<Band> bands((image.height + rows - 1) / rows);
  const Bytes zeros(row_bytes, 0);
  const auto compress = [&](Index i) {
    const int begin = i * rows, end = std::min(image.height, begin + rows);
    Bytes bytes;
    bytes.reserve((end - begin) * (row_bytes + 1));
    for (int y = begin; y < end; ++y)
      appendRow(image.pixel(0, y), y > 0 ? image.pixel(0, y - 1) : zeros.data(), image, bytes);
    bands[i] = compressed(bytes, end == image.height);
  };
  parallelFor(bands.size(), 0, compress, 1);
  return bands;
}
/// @param image whose channels are bytes of a pixel
/// @param depth bits a sample; color_type 0 grey, 2 RGB, 6 RGBA
Bytes encode(const Image& image, std::uint8_t depth, std::uint8_t color_type)
{
  const std::vector<Band> bands = compressedRows(image);
  Bytes out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, header;
  appendNumber(image.width, header);
  appendNumber(image.height, header);
  header.insert(header.end(), {depth, color_type, 0, 0, 0});
  appendChunk("IHDR", header, out);
  appendChunk("IDAT", {0x78, 0x01}, out); // zlib's header: window of 32 kB, fastest
  uLong check = adler32(0, nullptr, 0);
  for (const Band& band : bands) {
    check = adler32_combine(check, band.check, band.length);
    appendChunk("IDAT", band.data, out);
  }
  Bytes end;
  appendNumber(check, end);
  appendChunk("IDAT", end, out);
  appendChunk("IEND", {}, out);
  return out;
}
} // namespace

std::vector<std::uint8_t> encodePng(const Image& image)
{
  return encode(image, 8, image.channels == 1 ? 0 : image.channels == 3 ? 2 : 6);
}

std::vector<std::uint8_t> encodePng(const Image16& image)
{
  Image bytes(image.width, image.height, 2); // the high byte first
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    bytes.data[2 * i] = image.data[i] >> 8;
    bytes.data[2 * i + 1] = image.data[i] & 0xff;
  }
  return encode(bytes, 16, 0);
}
} // namespace fresco::io
