// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <cstdint>
namespace fresco::io::e57 {
/// Bits that the whole numbers `minimum` .. `maximum` need, 0..64: each is stored as its distance from `minimum`.
int bitWidth(std::int64_t minimum, std::int64_t maximum);

/// Bytes that must be readable behind the last one of a packed stream.
inline constexpr std::size_t unpack_slack = 16;

/// Whole numbers one after the other in a little-endian stream, the lowest bit first.
struct PackedIntegers {
  const std::uint8_t* stream; ///< unpack_slack bytes behind its end are readable
  std::size_t first_bit;      ///< where the first number begins
  int bits;                   ///< of a number, 0..64
  std::int64_t minimum;       ///< is added
};

void unpackIntegers(const PackedIntegers& packed, std::size_t count, std::int64_t* numbers);
} // namespace fresco::io::e57
