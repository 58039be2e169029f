// SPDX-License-Identifier: BSD-3-Clause
// Stands in for parallel.cpp in ThreadSanitizer builds: TBB's library is not built with the sanitizer, which would take
// every hand-over of work inside it for a race. std::thread is known to the sanitizer, and the loops' bodies are the
// same.
#include <atomic>
#include <exception>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
#include <mutex>
#include <thread>
namespace fresco {
namespace {
std::atomic<int> default_threads{0};
thread_local bool is_worker = false;

int coreCount() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

/// The chunks that are left, and what went wrong.
struct Work {
  const Index count;
  const std::function<void(Index)>& run;
  std::atomic<Index> next{0};
  std::mutex mutex;
  std::exception_ptr error;

  void takeChunks()
  {
    for (Index chunk = next++; chunk < count; chunk = next++)
      try {
        run(chunk);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        error = error ? error : std::current_exception();
        next = count;
      }
  }
};
} // namespace

int threadCount(int threads)
{
  require(threads >= 0, "threads ", threads, " is negative");
  const int chosen = threads > 0 ? threads : default_threads.load();
  return chosen > 0 ? chosen : coreCount();
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
  if (workers <= 1 || is_worker) {
    for (Index c = 0; c < count; ++c)
      run(c);
    return;
  }
  Work work{count, run, {}, {}, {}};
  std::vector<std::thread> pool;
  for (int i = 1; i < workers; ++i)
    pool.emplace_back([&] {
      is_worker = true;
      work.takeChunks();
    });
  work.takeChunks();
  for (std::thread& thread : pool)
    thread.join();
  if (work.error)
    std::rethrow_exception(work.error);
}
} // namespace detail
} // namespace fresco
