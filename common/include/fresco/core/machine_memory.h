// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/export.h>
namespace fresco {
/// Bytes that this process can have at most: what the machine has, what its control group may use (cgroup v2, as
/// containers and systemd set it) and what is left of its address space (`ulimit -v`), whichever is least.
FRESCO_EXPORT std::size_t machineMemory();
} // namespace fresco
