// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
namespace fresco {
/// The lower 21 bits of `v` with two zero bits between each.
inline std::uint64_t spreadBits(std::uint64_t v)
{
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

/// Inverse of spreadBits(); other bits are ignored.
inline std::uint32_t gatherBits(std::uint64_t v)
{
  v &= 0x1249249249249249;
  v = (v | v >> 2) & 0x10c30c30c30c30c3;
  v = (v | v >> 4) & 0x100f00f00f00f00f;
  v = (v | v >> 8) & 0x1f0000ff0000ff;
  v = (v | v >> 16) & 0x1f00000000ffff;
  return static_cast<std::uint32_t>((v | v >> 32) & 0x1fffff);
}

/// Position along the Z-order curve; x is the lowest bit.
inline std::uint64_t mortonCode(std::uint32_t x, std::uint32_t y, std::uint32_t z)
{
  return spreadBits(x) | spreadBits(y) << 1 | spreadBits(z) << 2;
}

inline std::array<int, 3> mortonCell(std::uint64_t code)
{
  return {static_cast<int>(gatherBits(code)), static_cast<int>(gatherBits(code >> 1)),
          static_cast<int>(gatherBits(code >> 2))};
}
} // namespace fresco
