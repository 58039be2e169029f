// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/image_samples.h"
#include "common/io/memory_limit.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <map>
#include <zlib.h>
namespace {
using namespace fresco;
using namespace fresco::test::images;

/// Codes as TIFF has them: the high bit first, 9 to 12 bits, a new table after 4093 words.
std::string packedLzw(const std::string& bytes)
{
  std::string out;
  std::uint32_t held = 0, bits = 0, size = 9;
  std::map<std::string, std::uint32_t> words;
  const auto put = [&](std::uint32_t code) {
    bits = bits << size | code;
    for (held += size; held >= 8; held -= 8)
      out += static_cast<char>(bits >> (held - 8));
  };
  const auto restart = [&] {
    put(256);
    words.clear();
    for (int i = 0; i < 256; ++i)
      words[std::string(1, static_cast<char>(i))] = i;
    size = 9;
  };
  restart();
  std::string word;
  std::uint32_t next = 258;
  for (const char letter : bytes) {
    if (words.count(word + letter) > 0) {
      word += letter;
      continue;
    }
    put(words.at(word));
    words[word + letter] = next++;
    word = letter;
    size = next > 2047 ? 12 : next > 1023 ? 11 : next > 511 ? 10 : 9;
    if (next == 4094) {
      restart();
      next = 258;
    }
  }
  put(words.at(word));
  ++next;
  size = next > 2047 ? 12 : next > 1023 ? 11 : next > 511 ? 10 : 9;
  put(257);
  put(0); // fills the last byte
  return out;
}

std::string packedBits(const std::string& bytes)
{
  std::string out;
  for (std::size_t i = 0; i < bytes.size();) {
    std::size_t run = 1;
    while (i + run < bytes.size() && bytes[i + run] == bytes[i] && run < 128)
      ++run;
    if (run == 1)
      out += {0, bytes[i]};
    else
      out += {static_cast<char>(1 - static_cast<int>(run)), bytes[i]};
    i += run;
  }
  return out;
}

std::string packed(const std::string& bytes, int compression)
{
  if (compression == 5)
    return packedLzw(bytes);
  if (compression == 32773)
    return packedBits(bytes);
  if (compression == 1)
    return bytes;
  std::string out(compressBound(bytes.size()), '\0');
  uLongf size = out.size();
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return out.substr(0, size);
}

struct TiffLayout {
  int compression, photometric;
  bool low_first, tiled, predicted, apart;
};

/// Bytes of one part of an image from (x0, y0) on, before they are packed.
std::string partBytes(const Samples& samples, const TiffLayout& layout, const Eigen::Array4i& part, int plane)
{
  std::string bytes;
  const int step = layout.apart ? 1 : samples.channels;
  for (int y = part[1]; y < part[1] + part[3]; ++y)
    for (int i = 0; i < part[2] * step; ++i) {
      const auto at = [&](int k) {
        const int x = part[0] + k / step;
        return x < width && y < height ? samples.at(x, y, layout.apart ? plane : k % step) : 0;
      };
      const std::uint32_t value = at(i) - (layout.predicted && i >= step ? at(i - step) : 0);
      if (samples.bits == 8)
        bytes += static_cast<char>(value);
      else
        bytes +=
            layout.low_first ? std::string{char(value), char(value >> 8)} : std::string{char(value >> 8), char(value)};
    }
  return bytes;
}

void putTiff(const std::string& path, const Samples& samples, const TiffLayout& layout)
{
  const auto number = [&](std::uint32_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i)
      text += static_cast<char>(value >> 8 * (layout.low_first ? i : bytes - 1 - i));
    return text;
  };
  const int part_width = layout.tiled ? 32 : width, part_height = 16;
  std::string file = (layout.low_first ? "II" : "MM") + number(42, 2) + number(0, 4), offsets, sizes;
  int parts = 0;
  for (int plane = 0; plane < (layout.apart ? samples.channels : 1); ++plane)
    for (int y = 0; y < height; y += part_height)
      for (int x = 0; x < width; x += part_width, ++parts) {
        const int rows = layout.tiled ? part_height : std::min(part_height, height - y);
        const std::string bytes =
            packed(partBytes(samples, layout, {x, y, part_width, rows}, plane), layout.compression);
        offsets += number(file.size(), 4);
        sizes += number(bytes.size(), 4);
        file += bytes;
      }
  std::string palette;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 256; ++i)
      palette += number(paletteColor(i)[c] * 257U, 2);
  std::string entries;
  int count = 0;
  const auto entry = [&](int tag, int type, std::uint32_t values, std::string data) {
    if (data.size() > 4) {
      const std::string place = number(file.size(), 4);
      file += data;
      data = place;
    }
    data.resize(4, '\0');
    entries += number(tag, 2) + number(type, 2) + number(values, 4) + data;
    ++count;
  };
  std::string bits;
  for (int c = 0; c < samples.channels; ++c)
    bits += number(samples.bits, 2);
  entry(256, 3, 1, number(width, 2));
  entry(257, 4, 1, number(height, 4));
  entry(258, 3, samples.channels, bits);
  entry(259, 3, 1, number(layout.compression, 2));
  entry(262, 3, 1, number(layout.photometric, 2));
  entry(layout.tiled ? 324 : 273, 4, parts, offsets);
  entry(277, 3, 1, number(samples.channels, 2));
  entry(278, 3, 1, number(part_height, 2));
  entry(layout.tiled ? 325 : 279, 4, parts, sizes);
  entry(284, 3, 1, number(layout.apart ? 2 : 1, 2));
  entry(317, 3, 1, number(layout.predicted ? 2 : 1, 2));
  entry(320, 3, 768, palette);
  if (layout.tiled) {
    entry(322, 3, 1, number(part_width, 2));
    entry(323, 3, 1, number(part_height, 2));
  }
  file.replace(4, 4, number(file.size(), 4));
  writeFile(path, file + number(count, 2) + entries + number(0, 4));
}

TEST(Images, EveryKindOfTiff)
{
  const std::string path = test::scratchFolder() + "/a.tif";
  constexpr int white_is_zero = 0, black_is_zero = 1, rgb = 2, palette = 3;
  for (const int compression : {1, 5, 8, 32773, 32946})
    for (const bool low_first : {false, true})
      for (const bool tiled : {false, true})
        for (const bool predicted : {false, true})
          for (const auto& [channels, bits, photometric] : {std::array{1, 8, white_is_zero},
                                                            {1, 8, black_is_zero},
                                                            {3, 8, rgb},
                                                            {4, 8, rgb},
                                                            {1, 8, palette},
                                                            {1, 16, black_is_zero},
                                                            {3, 16, rgb}}) {
            const Samples samples(channels, bits);
            const TiffLayout layout{compression, photometric, low_first, tiled, predicted, channels == 4};
            SCOPED_TRACE(concat("compression ", compression, ", low first ", low_first, ", tiled ", tiled,
                                ", predicted ", predicted, ", ", channels, " of ", bits, " bits"));
            putTiff(path, samples, layout);
            expectColors(path, [&, photometric = photometric, bits = bits](int x, int y, int c) -> int {
              const std::uint32_t value = samples.at(x, y, photometric == rgb ? c : 0) >> (bits - 8);
              return photometric == palette         ? paletteColor(value)[c]
                     : photometric == white_is_zero ? 255 - value
                                                    : value;
            });
            if (bits == 16 && channels == 1) {
              EXPECT_TRUE(std::equal(samples.values.begin(), samples.values.end(), readImage16(path).data.begin()));
            }
          }
}

TEST(Images, DamagedTiffIsAnErrorOrAnImage)
{
  const std::string folder = test::scratchFolder();
  std::mt19937 random(3);
  const test::MemoryLimit limit;
  for (const int compression : {1, 5, 8, 32773}) {
    putTiff(folder + "/whole.tif", Samples(3, 8), {compression, 2, true, compression == 5, true, false});
    const std::string whole = readFile(folder + "/whole.tif");
    for (int round = 0; round < 1500; ++round) {
      std::string broken = whole;
      for (int i = 0; i < 3; ++i) // mostly in the table at the end
        broken[random() % 2 ? whole.size() - 1 - random() % 200 : random() % whole.size()] =
            static_cast<char>(random());
      if (round % 5 == 0)
        broken.resize(random() % broken.size() + 1);
      writeFile(folder + "/broken.tif", broken);
      const std::string error = test::errorOf([&] { readImage(folder + "/broken.tif"); });
      EXPECT_TRUE(error.empty() || error.find("broken.tif") != std::string::npos) << error;
      EXPECT_EQ(error.find("memory"), std::string::npos) << error;
    }
  }
}
} // namespace
