// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/paged_file.h"
#include "io/files/expect.h"
#include <algorithm>
#include <array>
#include <cstring>
#include <fresco/core/point_table.h>
namespace fresco::io::e57 {
namespace {
constexpr std::uint64_t pages_per_read = 128; // 128 kB: two data packets of the largest size

/// tables[k][b]: the checksum of byte b followed by k zero bytes ("slicing by 8", Kounavis & Berry 2005).
using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Tables makeTables()
{
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t value = byte;
    for (int bit = 0; bit < 8; ++bit)
      value = (value >> 1) ^ ((value & 1U) != 0 ? 0x82F63B78U : 0U); // 0x1EDC6F41 with its bits reversed
    tables[0][byte] = value;
  }
  for (std::size_t k = 1; k < tables.size(); ++k)
    for (std::size_t byte = 0; byte < 256; ++byte)
      tables[k][byte] = (tables[k - 1][byte] >> 8) ^ tables[0][tables[k - 1][byte] & 0xFFU];
  return tables;
}

constexpr Tables tables = makeTables();

Header readHeader(const RandomAccessFile& file)
{
  char bytes[48];
  expect(file.size() >= sizeof(bytes), "not an E57 file: too short");
  file.read(0, bytes, sizeof(bytes));
  expect(std::memcmp(bytes, "ASTM-E57", 8) == 0, "not an E57 file: it does not begin with ASTM-E57");
  const auto version = loadScalar<std::uint32_t>(bytes + 8);
  expect(version == 1, "version ", version, " of E57 is not known");
  const auto stored_page_size = loadScalar<std::uint64_t>(bytes + 40);
  expect(stored_page_size == page_size, "pages of ", stored_page_size, " bytes; E57 has ", page_size);
  return {loadScalar<std::uint64_t>(bytes + 16), loadScalar<std::uint64_t>(bytes + 24),
          loadScalar<std::uint64_t>(bytes + 32)};
}

/// The checksum is stored with its highest byte first.
std::uint32_t storedChecksum(const char* page)
{
  std::uint32_t value = 0;
  for (std::size_t i = page_payload; i < page_size; ++i)
    value = value << 8 | std::uint8_t(page[i]);
  return value;
}
} // namespace

std::uint32_t crc32c(const void* data, std::size_t bytes)
{
  const auto* at = static_cast<const unsigned char*>(data);
  std::uint32_t crc = 0xFFFFFFFFU;
  for (; bytes >= 8; bytes -= 8, at += 8) {
    const std::uint32_t low = crc ^ (std::uint32_t{at[0]} | std::uint32_t{at[1]} << 8 | std::uint32_t{at[2]} << 16 |
                                     std::uint32_t{at[3]} << 24);
    crc = tables[7][low & 0xFFU] ^ tables[6][low >> 8 & 0xFFU] ^ tables[5][low >> 16 & 0xFFU] ^ tables[4][low >> 24] ^
          tables[3][at[4]] ^ tables[2][at[5]] ^ tables[1][at[6]] ^ tables[0][at[7]];
  }
  for (; bytes > 0; --bytes, ++at)
    crc = (crc >> 8) ^ tables[0][(crc ^ *at) & 0xFFU];
  return ~crc;
}

PagedFile::PagedFile(const std::string& path) : file_(path), header_(readHeader(file_))
{
  expect(header_.file_length <= file_.size(), "truncated: the header says ", header_.file_length,
         " bytes, the file has ", file_.size());
  expect(header_.file_length % page_size == 0, "the header says ", header_.file_length,
         " bytes, which are no whole pages");
  pages_ = header_.file_length / page_size;
}

std::uint64_t PagedFile::logical(std::uint64_t physical) const
{
  const std::uint64_t page = physical / page_size, within = physical % page_size;
  expect(page < pages_ && within < page_payload, "offset ", physical,
         " lies beyond the end of the file or in a checksum");
  return page * page_payload + within;
}

void PagedFile::load(std::uint64_t page)
{
  const std::uint64_t count = std::min(pages_per_read, pages_ - page);
  loaded_.resize(count * page_size);
  file_.read(page * page_size, loaded_.data(), loaded_.size());
  first_loaded_ = page;
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* begin = loaded_.data() + i * page_size;
    if (crc32c(begin, page_payload) == storedChecksum(begin))
      continue;
    const std::string damage = concat("damaged: wrong checksum of page ", page + i + 1, " of ", pages_);
    if (errors_) {
      errors_->push_back(damage);
      continue;
    }
    loaded_.resize(i * page_size); // what comes before is good and may be all that is wanted
    expect(i != 0, damage);
    return;
  }
}

void PagedFile::readDamaged(std::uint64_t offset, void* to, std::size_t bytes, std::vector<std::string>& errors)
{
  loaded_.clear();
  errors_ = &errors;
  read(offset, to, bytes);
  errors_ = nullptr;
  loaded_.clear(); // they may hold pages that are damaged
}

void PagedFile::read(std::uint64_t offset, void* to, std::size_t bytes)
{
  expect(offset <= size() && bytes <= size() - offset, "truncated: ", bytes, " bytes expected, ",
         offset < size() ? size() - offset : 0, " before the end of the file");
  auto* at = static_cast<char*>(to);
  while (bytes > 0) {
    const std::uint64_t page = offset / page_payload;
    const std::size_t within = offset % page_payload;
    if (page < first_loaded_ || page >= first_loaded_ + loaded_.size() / page_size)
      load(page);
    const std::size_t part = std::min(bytes, page_payload - within);
    std::memcpy(at, loaded_.data() + (page - first_loaded_) * page_size + within, part);
    at += part;
    offset += part;
    bytes -= part;
  }
}
} // namespace fresco::io::e57
