// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <fresco/core/machine_memory.h>
#include <fstream>
#include <limits>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <string>
#include <sys/resource.h>
#include <unistd.h>
namespace fresco {
namespace {
constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

/// The least limit of the process's group and those around it.
std::size_t groupMemory()
{
  std::ifstream groups("/proc/self/cgroup");
  std::string line;
  while (std::getline(groups, line) && line.rfind("0::", 0) != 0) {
  }
  if (line.rfind("0::/", 0) != 0)
    return unlimited;
  std::size_t least = unlimited;
  const std::filesystem::path root = "/sys/fs/cgroup";
  for (std::filesystem::path group = root / line.substr(4);; group = group.parent_path()) {
    std::size_t limit = 0;
    if (std::ifstream(group / "memory.max") >> limit) // else "max", or a group without a limit
      least = std::min(least, limit);
    if (group == root || !group.has_relative_path())
      return least;
  }
}
/// What a limit of the address space leaves beside programs, libraries and data that are mapped already.
std::size_t leftOfAddressSpace()
{
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY)
    return unlimited;
  std::size_t mapped = 0; // pages
  std::ifstream("/proc/self/statm") >> mapped;
  mapped *= sysconf(_SC_PAGESIZE);
  return space.rlim_cur - std::min<std::size_t>(space.rlim_cur, mapped);
}
} // namespace

std::size_t machineMemory()
{
  const auto pages = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES));
  return std::min({pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)), groupMemory(), leftOfAddressSpace()});
}

void returnFreedMemory()
{
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}
} // namespace fresco
