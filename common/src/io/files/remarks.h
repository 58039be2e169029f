// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/files/expect.h"
#include <fresco/io/reading.h>
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

/// Tells the listener "PATH: text", with the file in hand.
FRESCO_EXPORT void remark(const std::string& text);
} // namespace fresco::io
