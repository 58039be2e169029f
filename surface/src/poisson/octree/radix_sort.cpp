// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/radix_sort.h"
#include <array>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
/// 1,024 counts, and the ends of as many runs, stay in the first-level cache.
constexpr int digit_bits = 10;
constexpr std::size_t digits = std::size_t(1) << digit_bits;
using Counts = std::array<std::uint32_t, digits>;

std::size_t digitOf(std::uint64_t item, int shift) { return item >> shift & (digits - 1); }

/// Turns the counts of each chunk into the places where its items of each digit begin.
void placeChunks(std::vector<Counts>& counts)
{
  std::uint32_t at = 0;
  for (std::size_t d = 0; d < digits; ++d)
    for (Counts& chunk : counts) {
      const std::uint32_t n = chunk[d];
      chunk[d] = at;
      at += n;
    }
}

void sortDigit(const Array<std::uint64_t>& from, Array<std::uint64_t>& to, int shift, int threads)
{
  const Index n = from.size();
  const Index chunk = std::max<Index>(1 << 14, (n + 31) / 32);
  std::vector<Counts> counts((n + chunk - 1) / chunk);
  const auto countsOf = [&](Index begin) -> Counts& { return counts[begin / chunk]; };
  parallelRanges(
      n, threads,
      [&](Index begin, Index end) {
        Counts& count = countsOf(begin);
        count.fill(0);
        for (Index i = begin; i < end; ++i)
          ++count[digitOf(from[i], shift)];
      },
      chunk);
  placeChunks(counts);
  parallelRanges(
      n, threads,
      [&](Index begin, Index end) {
        Counts& place = countsOf(begin);
        for (Index i = begin; i < end; ++i) {
          const std::uint64_t item = from[i];
          to[place[digitOf(item, shift)]++] = item;
        }
      },
      chunk);
}
} // namespace

void sortBits(Array<std::uint64_t>& items, int first_bit, int bits, int threads)
{
  Array<std::uint64_t> other(items.size());
  for (int shift = first_bit; shift < first_bit + bits; shift += digit_bits) {
    sortDigit(items, other, shift, threads);
    items.swap(other);
  }
}
} // namespace fresco::poisson
