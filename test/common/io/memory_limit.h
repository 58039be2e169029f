// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>
namespace fresco::test {
/// While it lives, the process may take 256 MiB more than it has: an allocation that a damaged count asks for fails.
class MemoryLimit {
public:
  MemoryLimit()
  {
    getrlimit(RLIMIT_AS, &before_);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit limit{pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + (std::size_t{256} << 20),
                       before_.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &before_); }

private:
  rlimit before_{};
};
} // namespace fresco::test
