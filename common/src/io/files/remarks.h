// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/files/expect.h"
#include <fresco/io/reading.h>
#include <new>
namespace fresco::io {
/// While it lives, what this thread remarks is of the file `path`.
class FRESCO_EXPORT FileInHand {
public:
  explicit FileInHand(const std::string& path);
  ~FileInHand();
  FileInHand(const FileInHand&) = delete;
  FileInHand& operator=(const FileInHand&) = delete;

private:
  const std::string* outer_;
};

/// use(); every error is a std::runtime_error "PATH: reason".
template <typename Use>
auto namingFile(const std::string& path, const Use& use) -> decltype(use())
try {
  const FileInHand file(path);
  return use();
} catch (const std::bad_alloc&) {
  throw std::runtime_error(path + ": not enough memory");
} catch (const std::exception& error) {
  throw std::runtime_error(path + ": " + error.what());
}

/// Tells the listener "PATH: text", with the file in hand.
FRESCO_EXPORT void remark(const std::string& text);
} // namespace fresco::io
