// SPDX-License-Identifier: BSD-3-Clause
#pragma once
namespace fresco {
/// Empties a vector and gives its memory back, which `v = {}` and clear() do not.
template <typename Vector>
void releaseMemory(Vector& v)
{
  Vector().swap(v);
}
} // namespace fresco
