// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <vector>
namespace fresco::volumetric {
/// Stable radix sort by `bits` bits of the items, from bit `first_bit` on.
void sortBits(std::vector<std::uint64_t>& items, int first_bit, int bits, int threads);
} // namespace fresco::volumetric
