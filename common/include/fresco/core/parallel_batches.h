// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/parallel.h>
#include <fresco/core/progress.h>
namespace fresco {
constexpr Index batch_size = 16; ///< of large items: as many are in memory, or done between two reports of progress
/// body(i) for i = 0..n-1 as parallelFor(); every few of them progress is reported, which may stop the work.
template <typename Body>
void parallelBatches(Index n, int threads, const Progress& progress, const std::string& step, const Body& body)
{
  for (Index begin = 0; begin < n; begin += batch_size) {
    report(progress, step, double(begin) / n);
    parallelFor(
        std::min(batch_size, n - begin), threads, [&](Index k) { body(begin + k); }, 1);
  }
}
} // namespace fresco
