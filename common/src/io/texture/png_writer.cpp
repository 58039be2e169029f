// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/png_writer.h"
#include <algorithm>
#include <array>
#include <cstdlib>
#include <fresco/core/parallel.h>
#include <fresco/core/release.h>
#include <stdexcept>
#include <zlib.h>
namespace fresco::io {
namespace {
using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t band_bytes = 1 << 20; // a choice that the bytes depend on
constexpr int level = 4; // with runs for matches (Z_RLE): rows of a photograph, once filtered, repeat little else

void appendNumber(std::size_t value, Bytes& out)
{
  for (int shift = 24; shift >= 0; shift -= 8)
    out.push_back(value >> shift);
}

/// Length, type, data, check sum.
void appendChunk(const char* type, const Bytes& data, Bytes& out)
{
  appendNumber(data.size(), out);
  const std::size_t begin = out.size();
  out.insert(out.end(), type, type + 4);
  out.insert(out.end(), data.begin(), data.end());
  appendNumber(crc32(0, out.data() + begin, out.size() - begin), out);
}

/// A row in each of the filters of the PNG standard that serve photographs, and how much of it is left.
class RowFilter {
public:
  explicit RowFilter(const Image& image)
      : image_(image), width_(static_cast<std::size_t>(image.width) * image.channels), zero_(width_, 0), sub_(width_),
        up_(width_), paeth_(width_)
  {}

  /// The filter's number and the row with the least sum of differences.
  void append(int y, Bytes& out)
  {
    const std::uint8_t *row = image_.pixel(0, y), *above = y > 0 ? image_.pixel(0, y - 1) : zero_.data();
    const std::size_t step = image_.channels;
    for (std::size_t i = 0; i < width_; ++i)
      up_[i] = row[i] - above[i];
    for (std::size_t i = 0; i < std::min(step, width_); ++i) {
      sub_[i] = row[i];
      paeth_[i] = up_[i];
    }
    for (std::size_t i = step; i < width_; ++i)
      sub_[i] = row[i] - row[i - step];
    for (std::size_t i = step; i < width_; ++i)
      paeth_[i] = row[i] - predicted(row[i - step], above[i], above[i - step]);
    const std::array<std::size_t, 3> sums = {sumOf(sub_), sumOf(up_), sumOf(paeth_)};
    const auto best = std::min_element(sums.begin(), sums.end()) - sums.begin();
    out.push_back(best == 0 ? 1 : best == 1 ? 2 : 4);
    const Bytes& chosen = best == 0 ? sub_ : best == 1 ? up_ : paeth_;
    out.insert(out.end(), chosen.begin(), chosen.end());
  }

private:
  /// Of left, above and above left the nearest to left + above - above left (Paeth 1991).
  static int predicted(int left, int above, int corner)
  {
    const int a = std::abs(above - corner), b = std::abs(left - corner), c = std::abs(left + above - 2 * corner);
    const int other = b <= c ? above : corner;
    return a <= b && a <= c ? left : other;
  }

  static std::size_t sumOf(const Bytes& differences)
  {
    unsigned sum = 0;
    for (const std::uint8_t d : differences)
      sum += static_cast<unsigned>(std::abs(static_cast<std::int8_t>(d)));
    return sum;
  }

  const Image& image_;
  std::size_t width_;
  Bytes zero_, sub_, up_, paeth_;
};

/// Rows first..last-1, filtered and packed: a piece of a zlib stream that ends at a byte.
struct Band {
  Bytes packed;
  uLong check = 0; ///< of the filtered bytes
  std::size_t size = 0;
};

Band packRows(const Image& image, int first, int last)
{
  Bytes rows;
  RowFilter filter(image);
  for (int y = first; y < last; ++y)
    filter.append(y, rows);
  Band band;
  band.size = rows.size();
  band.check = adler32(1, rows.data(), rows.size());
  z_stream stream{};
  const int raw = -15; // bits of the window; negative: without the stream's own head and check sum
  if (deflateInit2(&stream, level, Z_DEFLATED, raw, 9, Z_RLE) != Z_OK)
    throw std::runtime_error("PNG: out of memory");
  band.packed.resize(deflateBound(&stream, rows.size()) + 16);
  stream.next_in = rows.data();
  stream.avail_in = rows.size();
  stream.next_out = band.packed.data();
  stream.avail_out = band.packed.size();
  deflate(&stream, last == image.height ? Z_FINISH : Z_SYNC_FLUSH);
  band.packed.resize(band.packed.size() - stream.avail_out);
  deflateEnd(&stream);
  return band;
}

Bytes header(const Image& image)
{
  Bytes out;
  appendNumber(image.width, out);
  appendNumber(image.height, out);
  const std::uint8_t color = image.channels == 1 ? 0 : image.channels == 3 ? 2 : 6;
  out.insert(out.end(), {8, color, 0, 0, 0}); // bits a channel, kind; deflate, filters, not interlaced
  return out;
}
} // namespace

std::vector<std::uint8_t> encodePng(const Image& image, int threads)
{
  const std::size_t row = static_cast<std::size_t>(image.width) * image.channels + 1;
  const int rows = std::max<std::size_t>(1, band_bytes / row);
  std::vector<Band> bands((image.height + rows - 1) / rows);
  parallelFor(
      bands.size(), threads,
      [&](Index b) {
        const int first = b * rows;
        bands[b] = packRows(image, first, std::min(image.height, first + rows));
      },
      1);
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  appendChunk("IHDR", header(image), out);
  uLong check = 1;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    check = adler32_combine(check, bands[b].check, bands[b].size);
    if (b == 0)
      bands[b].packed.insert(bands[b].packed.begin(), {0x78, 0x5e}); // a zlib stream with a window of 32 kB
    if (b + 1 == bands.size())
      appendNumber(check, bands[b].packed);
    appendChunk("IDAT", bands[b].packed, out);
    releaseMemory(bands[b].packed);
  }
  appendChunk("IEND", {}, out);
  return out;
}
} // namespace fresco::io
