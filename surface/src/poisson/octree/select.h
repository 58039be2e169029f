// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/array.h>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
/// Elements that one task takes at a time: what it counts or sums up is small beside them, and 32 kB of numbers stay in
/// the cache between two operations.
constexpr Index chunk_size = 1 << 12;

/// The numbers i of 0..n-1 with holds(i), rising.
/// @param append_end n follows them, as the end of the last run
template <typename Predicate>
Array<std::uint32_t> selectIndices(Index n, int threads, const Predicate& holds, bool append_end = false)
{
  std::vector<std::size_t> place((n + chunk_size - 1) / chunk_size + 1, 0);
  const auto placeOf = [&](Index begin) -> std::size_t& { return place[begin / chunk_size]; };
  parallelRanges(
      n, threads,
      [&](Index begin, Index end) {
        std::size_t count = 0;
        for (Index i = begin; i < end; ++i)
          count += holds(i) ? 1 : 0;
        placeOf(begin) = count;
      },
      chunk_size);
  std::size_t total = 0;
  for (std::size_t& p : place) {
    const std::size_t count = p;
    p = total;
    total += count;
  }
  Array<std::uint32_t> indices(total + (append_end ? 1 : 0));
  parallelRanges(
      n, threads,
      [&](Index begin, Index end) {
        std::size_t at = placeOf(begin);
        for (Index i = begin; i < end; ++i)
          if (holds(i))
            indices[at++] = i;
      },
      chunk_size);
  if (append_end)
    indices.back() = n;
  return indices;
}

/// First element of each run of equal keys among 0..n-1, and n.
template <typename Key>
Array<std::uint32_t> runBegins(Index n, int threads, const Key& key)
{
  return selectIndices(
      n, threads, [&](Index i) { return i == 0 || key(i) != key(i - 1); }, true);
}
} // namespace fresco::poisson
