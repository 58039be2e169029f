// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco {
/// Name of a file that is needed for a while only: removed with this object, and by abandonUnfinishedFiles().
class TemporaryFile {
public:
  explicit TemporaryFile(std::string path); ///< makes no file
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

private:
  std::string path_;
};

/// Removes what every OutputFile of this process has written and not committed, and every TemporaryFile: for a program
/// that ends at once, without unwinding. No OutputFile can be made or committed afterwards (the caller blocks for
/// ever).
void abandonUnfinishedFiles() noexcept;
} // namespace fresco
