// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <fresco/core/require.h>
#include <string>
#include <unistd.h>
namespace fresco::io {
/// A temporary file that some process has made, to be written at any place.
class OpenFile {
public:
  /// @param path for messages
  OpenFile(const std::string& path, const std::string& temporary)
      : path_(path), descriptor_(::open(temporary.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC))
  {
    if (descriptor_ < 0)
      fail();
  }
  ~OpenFile() { ::close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  void write(std::uint64_t offset, const void* data, std::size_t bytes) const
  {
    constexpr std::size_t piece = std::size_t{8} << 20; // a call under way holds up the end of the process
    const auto* from = static_cast<const char*>(data);
    while (bytes > 0) {
      const ssize_t done = ::pwrite(descriptor_, from, std::min(bytes, piece), static_cast<off_t>(offset));
      if (done < 0 && errno == EINTR)
        continue;
      if (done < 0)
        fail();
      from += done;
      offset += static_cast<std::size_t>(done);
      bytes -= static_cast<std::size_t>(done);
    }
  }

  /// Returns when it lies on the disk.
  void finish() const
  {
    if (::fsync(descriptor_) != 0 && errno != EINVAL)
      fail();
  }

private:
  [[noreturn]] void fail() const
  {
    throw std::runtime_error(concat(path_, ": cannot be written (", std::strerror(errno), ")"));
  }
  std::string path_;
  int descriptor_ = -1;
};
} // namespace fresco::io
