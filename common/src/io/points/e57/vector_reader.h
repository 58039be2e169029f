// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/e57/content.h"
namespace fresco::io::e57 {
/// The records of a compressed vector, a window at a time (ASTM E2807-11, 9): packets hold a piece of the stream of each
/// field; a record may begin in one packet and end in the next.
class VectorReader {
public:
  /// Records are at least this small: a section cannot announce more than its bytes may hold.
  static constexpr std::uint64_t least_bits_per_record = 1;

  /// @throws std::runtime_error if the section is damaged, beyond the end of the file, or too short for its records
  VectorReader(PagedFile& file, const CompressedVector& records);

  /// Decodes the next window. @return its records, at most `most`; 0 = the end
  /// @throws std::runtime_error if a packet is damaged or the section ends early
  std::size_t next(std::size_t most);

  /// After the last record. @throws std::runtime_error if the section holds more
  void requireEnd();

  /// Of record `i` of the window. Strings are 0.
  double real(std::size_t field, std::size_t i) const
  {
    const Stream& stream = streams_[field];
    return stream.integers.empty() ? stream.reals[i] : double(stream.integers[i]) * stream.scale + stream.offset;
  }
  /// As stored: fields of whole numbers only.
  std::int64_t stored(std::size_t field, std::size_t i) const { return streams_[field].integers[i]; }

private:
  struct Stream {
    std::vector<std::uint8_t> bytes; ///< not decoded yet, and some to read beyond
    std::size_t size = 0;            ///< bytes without the slack
    std::size_t bit = 0;             ///< first one not decoded
    double scale = 1, offset = 0;
    std::vector<std::int64_t> integers; ///< the window's
    std::vector<double> reals;

    void append(const std::uint8_t* more, std::size_t count);
    void dropDecoded();
  };
  bool holds(std::size_t field, std::size_t records) const;
  void readPacket();
  void distribute(std::size_t length);
  void decode(std::size_t field, std::size_t count);
  void decodeStrings(Stream& stream, std::size_t count) const;

  PagedFile& file_;
  const CompressedVector& records_;
  std::uint64_t packet_ = 0, end_ = 0; ///< logical offsets: next packet, end of the section
  std::uint64_t left_ = 0;             ///< records
  std::vector<Stream> streams_;
  std::vector<std::uint8_t> buffer_; ///< a packet
};
} // namespace fresco::io::e57
