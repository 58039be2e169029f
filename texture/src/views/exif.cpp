// SPDX-License-Identifier: BSD-3-Clause
#include "views/exif.h"
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>
namespace fresco::texture {
namespace {
/// Bytes of a TIFF block in either byte order; 0 beyond its end.
class Tiff {
public:
  explicit Tiff(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)), low_first_(byte(0) == 'I') {}
  std::uint32_t number(std::size_t at, int length) const
  {
    std::uint32_t value = 0;
    for (int i = 0; i < length; ++i)
      value |= byte(at + i) << 8 * (low_first_ ? i : length - 1 - i);
    return value;
  }

private:
  std::uint32_t byte(std::size_t at) const { return at < bytes_.size() ? bytes_[at] : 0U; }
  std::vector<std::uint8_t> bytes_;
  bool low_first_;
};

int orientationIn(const Tiff& tiff)
{
  const std::size_t table = tiff.number(4, 4);
  const std::uint32_t entries = std::min(tiff.number(table, 2), 512U);
  for (std::uint32_t i = 0; i < entries; ++i)
    if (const std::size_t entry = table + 2 + 12 * i; tiff.number(entry, 2) == 274) {
      const int value = tiff.number(entry + 8, 2);
      return value >= 1 && value <= 8 ? value : 1;
    }
  return 1;
}
} // namespace

int exifOrientation(const std::string& path)
{
  if (!std::filesystem::is_regular_file(path)) // reading the photograph says what is wrong
    return 1;
  std::ifstream file(path, std::ios::binary);
  const auto next = [&] { return static_cast<unsigned>(file.get()) & 255U; };
  if (next() != 0xFF || next() != 0xD8)
    return 1;
  while (file && next() == 0xFF) {
    const unsigned marker = next();
    const unsigned high = next(), length = high << 8 | next();
    if (!file || marker == 0xDA || length < 2) // the picture itself begins
      return 1;
    std::vector<std::uint8_t> block(length - 2);
    if (marker != 0xE1) {
      file.seekg(block.size(), std::ios::cur);
      continue;
    }
    file.read(reinterpret_cast<char*>(block.data()), block.size());
    const std::string name = "Exif";
    if (file && block.size() > 14 && std::equal(name.begin(), name.end(), block.begin()))
      return orientationIn(Tiff({block.begin() + 6, block.end()}));
  }
  return 1;
}
} // namespace fresco::texture
