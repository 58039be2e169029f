// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/array.h>
namespace fresco::poisson {
/// Stable radix sort by `bits` bits of the items, from bit `first_bit` on.
void sortBits(Array<std::uint64_t>& items, int first_bit, int bits, int threads);
} // namespace fresco::poisson
