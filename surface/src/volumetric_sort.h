// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <vector>
namespace fresco::volumetric {
struct KeyIndex {
  std::uint64_t key;
  std::uint32_t index;
};

/// Stable radix sort by the lowest `bits` bits of the keys.
void sortByKey(std::vector<KeyIndex>& items, int bits, int threads);
} // namespace fresco::volumetric
