// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
namespace fresco {
namespace {
std::atomic<int> default_threads{0};
}

int threadCount(int threads)
{
  require(threads >= 0, "threads ", threads, " is negative");
  const int chosen = threads > 0 ? threads : default_threads.load();
  return chosen > 0 ? chosen : tbb::info::default_concurrency();
}

void setDefaultThreads(int threads)
{
  require(threads >= 0, "threads ", threads, " is negative");
  default_threads = threads;
}

namespace detail {
void runChunks(Index count, int threads, const std::function<void(Index)>& run)
{
  const int workers = static_cast<int>(std::min<Index>(threadCount(threads), count));
  if (workers <= 1 || tbb::this_task_arena::current_thread_index() > 0) {
    for (Index c = 0; c < count; ++c)
      run(c);
    return;
  }
  // The library caps its pool at the number of cores unless told otherwise; a caller who asks for more gets more.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(std::max(workers, tbb::info::default_concurrency())));
  tbb::task_arena arena(workers);
  arena.execute([&] { tbb::parallel_for(Index(0), count, run, tbb::simple_partitioner()); });
}
} // namespace detail
} // namespace fresco
