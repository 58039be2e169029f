// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
namespace fresco::poisson {
/// Number of bits that are set. The compiler's own is a call where the processor need not have the instruction.
constexpr int bitCount(std::uint64_t v)
{
  v -= v >> 1 & 0x5555555555555555;
  v = (v & 0x3333333333333333) + (v >> 2 & 0x3333333333333333);
  return static_cast<int>(((v + (v >> 4)) & 0x0f0f0f0f0f0f0f0f) * 0x0101010101010101 >> 56);
}
} // namespace fresco::poisson
