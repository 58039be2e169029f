// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <cstring>
#include <fresco/io/file.h>
#include <stdexcept>
#include <string>
namespace fresco::io {
[[noreturn]] inline void fail(const std::string& where, const std::string& reason)
{
  throw std::runtime_error(where + ": " + reason);
}

/// Little-endian reader that never reads beyond the end.
class ByteReader {
public:
  explicit ByteReader(const std::string& path) : path_(path), data_(readFile(path)) {}

  template <typename T>
  T next()
  {
    requireLeft(1, sizeof(T));
    T value;
    std::memcpy(&value, data_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  std::string text()
  {
    const std::size_t end = data_.find('\0', at_);
    if (end == std::string::npos)
      fail(path_, "the file is truncated");
    std::string word = data_.substr(at_, end - at_);
    at_ = end + 1;
    return word;
  }

  /// @throws std::runtime_error unless `count` items of `size` bytes follow
  void requireLeft(std::uint64_t count, std::size_t size) const
  {
    if (count > (data_.size() - at_) / size)
      fail(path_, "the file is truncated");
  }

  void skip(std::uint64_t count, std::size_t size)
  {
    requireLeft(count, size);
    at_ += static_cast<std::size_t>(count) * size;
  }

private:
  std::string path_, data_;
  std::size_t at_ = 0;
};
} // namespace fresco::io
