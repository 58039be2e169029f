// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/file_window.h"
#include <string>
#include <vector>
namespace fresco::io::e57 {
/// Bytes of a page, of which the last four are the CRC32C of the others (ASTM E2807-11, 5.3).
inline constexpr std::size_t page_size = 1024;
inline constexpr std::size_t page_payload = page_size - 4;

/// CRC32C (Castagnoli) as RFC 3720 has it.
std::uint32_t crc32c(const void* data, std::size_t bytes);

/// The file header, 48 bytes.
struct Header {
  std::uint64_t file_length = 0; ///< bytes, with checksums
  std::uint64_t xml_offset = 0;  ///< physical
  std::uint64_t xml_length = 0;  ///< bytes without checksums
};

/// An E57 file without its checksums, which are verified as the pages are read. Offsets are "logical" (checksums do not
/// count) unless said otherwise.
class PagedFile {
public:
  /// @throws std::runtime_error if it is no E57 file, cut, or of a version or page size that is not known
  explicit PagedFile(const std::string& path);

  const Header& header() const { return header_; }
  std::uint64_t size() const { return pages_ * page_payload; }

  /// The logical offset of a physical one. @throws std::runtime_error if it lies beyond the end or in a checksum
  std::uint64_t logical(std::uint64_t physical) const;

  /// @throws std::runtime_error if the file does not have these bytes, or naming a page whose checksum is wrong
  void read(std::uint64_t offset, void* to, std::size_t bytes);

  /// The same, but a wrong checksum is told to `errors` alone.
  void readDamaged(std::uint64_t offset, void* to, std::size_t bytes, std::vector<std::string>& errors);

private:
  void load(std::uint64_t page);
  RandomAccessFile file_;
  Header header_;
  std::uint64_t pages_ = 0;
  std::uint64_t first_loaded_ = 0;             ///< page
  std::vector<char> loaded_;                   ///< verified pages one after the other, with their checksums
  std::vector<std::string>* errors_ = nullptr; ///< whom to tell of wrong checksums
};
} // namespace fresco::io::e57
