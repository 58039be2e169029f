// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
namespace fresco::io {
/// A file read at any place, a piece at a time: for files that are larger than memory.
class RandomAccessFile {
public:
  /// @throws std::runtime_error "no such file" ... (without the path)
  explicit RandomAccessFile(const std::string& path);
  ~RandomAccessFile();
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;

  std::uint64_t size() const { return size_; }
  /// Exactly `bytes` bytes from `offset`. @throws std::runtime_error if the file does not have them
  void read(std::uint64_t offset, void* to, std::size_t bytes) const;

private:
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// The lines of a part of a text file, of which only a window is in memory. Lines end with LF or CR LF.
class LineReader {
public:
  explicit LineReader(const RandomAccessFile& file) : file_(file), end_(file.size()) {}
  /// @param line number of the one that begins at byte `begin`
  LineReader(const RandomAccessFile& file, std::uint64_t begin, std::uint64_t end, std::uint64_t line)
      : file_(file), offset_(begin), end_(end), line_(line)
  {}

  /// @param text valid until the next call; without blanks at its ends
  /// @return false at the end
  /// @throws std::runtime_error if a line has more than 2^20 bytes
  bool next(std::string_view& text);
  /// The line that next() gave last comes once more.
  void unread();

  std::uint64_t line() const { return line_ - 1; }       ///< number of the line that next() gave, from 1
  std::uint64_t offset() const { return offset_ + at_; } ///< byte where the next line begins
  std::uint64_t remaining() const { return end_ - offset(); }

private:
  bool fill();
  const RandomAccessFile& file_;
  std::uint64_t offset_ = 0, end_; ///< in the file: of the window, behind the last line
  std::uint64_t line_ = 1;
  std::string window_;
  std::size_t at_ = 0, last_ = 0; ///< in the window: next line, the one before
};
} // namespace fresco::io
