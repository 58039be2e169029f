// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/export.h>
namespace fresco {
/// Bytes that this process can have at most: what the machine has, what its control group may use (cgroup v2, as
/// containers and systemd set it) and what is left of its address space (`ulimit -v`), whichever is least.
FRESCO_EXPORT std::size_t machineMemory();

/// Gives memory that was freed, and that the allocator keeps for later, back to the machine. For use between stages that need
/// different things: what many small arrays leave behind rarely serves a few large ones. Does nothing without glibc.
FRESCO_EXPORT void returnFreedMemory();

/// Empties a vector and gives its memory back, which `v = {}` and clear() do not.
template <typename Vector>
void releaseMemory(Vector& v)
{
  Vector().swap(v);
}
} // namespace fresco
