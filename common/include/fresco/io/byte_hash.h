// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
namespace fresco {
/// 64 bits that tell bytes from other bytes, not from forged ones; to be chained over parts by `before`. For a given word of eight bytes
/// the steps are one to one in the hash, and for a given hash in the word: bytes that differ in one word never have the same.
inline std::uint64_t hashBytes(const void* bytes, std::size_t size, std::uint64_t before = 0)
{
  const auto mixed = [](std::uint64_t hash, std::uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL; // odd: 2^64 divided by the golden ratio
    return hash ^ hash >> 32;
  };
  std::uint64_t hash = mixed(before, ~std::uint64_t(size)); // not 0 of no bytes, nor of zeros
  for (std::size_t i = 0; i < size; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, static_cast<const char*>(bytes) + i, std::min<std::size_t>(8, size - i));
    hash = mixed(hash, word);
  }
  return hash;
}
} // namespace fresco
