// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/file_window.h"
#include "io/files/inputs.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
namespace fresco::io {
namespace {
constexpr std::size_t window_size = std::size_t{1} << 20; // a line of a scan has some 100 bytes

/// Bytes per call of the operating system: a process cannot end before the call under way has.
constexpr std::size_t piece_size = std::size_t{8} << 20;
} // namespace

RandomAccessFile::RandomAccessFile(const std::string& path)
{
  if (const std::string reason = reasonNotToOpen(path); !reason.empty())
    throw std::runtime_error(reason);
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status = {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0 || status.st_size == 0) {
    const std::string reason =
        descriptor_ < 0 ? concat("cannot be read (", std::strerror(errno), ")") : "the file is empty";
    if (descriptor_ >= 0)
      ::close(descriptor_);
    throw std::runtime_error(reason);
  }
  size_ = status.st_size;
  rememberInput(path);
}

RandomAccessFile::~RandomAccessFile() { ::close(descriptor_); }

void RandomAccessFile::read(std::uint64_t offset, void* to, std::size_t bytes) const
{
  expect(offset <= size_ && bytes <= size_ - offset, "truncated: ", bytes, " bytes expected at ", offset,
         ", the file has ", size_, " bytes");
  auto* at = static_cast<char*>(to);
  while (bytes > 0) {
    const ssize_t done = ::pread(descriptor_, at, std::min(bytes, piece_size), offset);
    if (done < 0 && errno == EINTR)
      continue;
    if (done <= 0)
      throw std::runtime_error(done == 0 ? "became shorter while it was read"
                                         : concat("cannot be read (", std::strerror(errno), ")"));
    at += done;
    offset += done;
    bytes -= done;
  }
}

bool LineReader::fill()
{
  offset_ += at_;
  window_.erase(0, at_);
  at_ = 0;
  const std::size_t held = window_.size();
  const std::size_t more = std::min<std::uint64_t>(window_size, end_ - offset_ - held);
  if (more == 0)
    return false;
  window_.resize(held + more);
  file_.read(offset_ + held, &window_[held], more);
  return true;
}

bool LineReader::next(std::string_view& text)
{
  std::size_t end = window_.find('\n', at_);
  while (end == std::string::npos) {
    const std::size_t searched = window_.size() - at_;
    expect(searched <= window_size, "line ", line_, ": longer than ", window_size, " bytes: not a text file");
    if (!fill())
      break;
    end = window_.find('\n', searched);
  }
  if (at_ == window_.size())
    return false;
  const std::size_t last = std::min(end, window_.size());
  constexpr std::string_view blanks(" \t\r\0", 4);
  text = trimmed(std::string_view(window_).substr(at_, last - at_), blanks);
  last_ = at_;
  at_ = std::min(last + 1, window_.size());
  ++line_;
  return true;
}

void LineReader::unread()
{
  at_ = last_;
  --line_;
}
} // namespace fresco::io
