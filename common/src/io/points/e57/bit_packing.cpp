// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/bit_packing.h"
#include <algorithm>
#include <cstring>
namespace fresco::io::e57 {
int bitWidth(std::int64_t minimum, std::int64_t maximum)
{
  std::uint64_t range = std::uint64_t(maximum) - std::uint64_t(minimum);
  int bits = 0;
  for (; range > 0; range >>= 1)
    ++bits;
  return bits;
}

void unpackIntegers(const PackedIntegers& packed, std::size_t count, std::int64_t* numbers)
{
  const auto [stream, first_bit, bits, minimum] = packed;
  if (bits == 0) {
    std::fill_n(numbers, count, minimum);
    return;
  }
  const std::uint64_t offset = minimum;
  const std::uint64_t mask = ~std::uint64_t{0} >> (64 - bits);
  std::size_t bit = first_bit;
  for (std::size_t i = 0; i < count; ++i, bit += bits) {
    const std::uint8_t* at = stream + bit / 8;
    const unsigned shift = bit % 8;
    std::uint64_t word;
    std::memcpy(&word, at, sizeof(word));
    word >>= shift;
    if (shift + bits > 64) // the rest lies in a ninth byte
      word |= std::uint64_t{at[8]} << (64 - shift);
    numbers[i] = (word & mask) + offset; // modulo 2^64
  }
}
} // namespace fresco::io::e57
