// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <functional>
#include <vector>
namespace fresco {
/// Number of threads that `threads` stands for: itself, 0 = the default, all cores unless set otherwise.
/// @throws std::invalid_argument if negative
FRESCO_EXPORT int threadCount(int threads);

/// What 0 stands for from now on in this process: for programs, which let their user choose once.
/// @param threads 0 = all cores. @throws std::invalid_argument if negative
FRESCO_EXPORT void setDefaultThreads(int threads);

namespace detail {
/// Runs run(0) .. run(count - 1), each once, in any order, on up to `threads` threads; blocks (never spins at a
/// barrier). The first exception of a chunk is thrown again here.
FRESCO_EXPORT void runChunks(Index count, int threads, const std::function<void(Index)>& run);

/// Elements per chunk. A function of n only, so that results do not depend on the number of threads.
inline Index chunkSize(Index n) { return std::clamp<Index>((n + 511) / 512, 1, 16384); }
} // namespace detail

/// body(begin, end) over disjoint ranges that cover 0..n-1; the ranges depend on n (and `chunk`) only.
/// @param threads 0 = all cores
/// @param chunk   elements per range, 0 = chosen from n
template <typename Body>
void parallelRanges(Index n, int threads, const Body& body, Index chunk = 0)
{
  if (n <= 0)
    return;
  const Index size = chunk > 0 ? chunk : detail::chunkSize(n);
  detail::runChunks((n + size - 1) / size, threads, [&](Index c) { body(c * size, std::min(n, (c + 1) * size)); });
}

/// body(i) for i = 0..n-1. A body writes only what belongs to i.
template <typename Body>
void parallelFor(Index n, int threads, const Body& body, Index chunk = 0)
{
  parallelRanges(
      n, threads,
      [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i)
          body(i);
      },
      chunk);
}

/// Joins map(begin, end) of all ranges in their order: same bits for any number of threads.
/// @param join join(accumulated, part) -> accumulated
template <typename Value, typename Map, typename Join>
Value parallelReduce(Index n, int threads, Value init, const Map& map, const Join& join, Index chunk = 0)
{
  const Index size = chunk > 0 ? chunk : detail::chunkSize(n);
  std::vector<Value> parts(n > 0 ? static_cast<std::size_t>((n + size - 1) / size) : 0, init);
  parallelRanges(
      n, threads, [&](Index begin, Index end) { parts[begin / size] = map(begin, end); }, size);
  Value total = init;
  for (const Value& part : parts)
    total = join(total, part);
  return total;
}

/// zero + f(0) + .. + f(n-1), in an order that does not depend on the number of threads.
template <typename Value, typename Function>
Value parallelSum(Index n, int threads, Value zero, const Function& f)
{
  const auto map = [&](Index begin, Index end) {
    Value sum = zero;
    for (Index i = begin; i < end; ++i)
      sum += f(i);
    return sum;
  };
  return parallelReduce(n, threads, zero, map, [](Value a, const Value& b) { return a += b; });
}
} // namespace fresco
