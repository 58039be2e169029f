// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "volumetric_array.h"
#include <cstdint>
namespace fresco::volumetric {
/// Stable radix sort by `bits` bits of the items, from bit `first_bit` on.
void sortBits(Array<std::uint64_t>& items, int first_bit, int bits, int threads);
} // namespace fresco::volumetric
