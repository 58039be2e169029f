// SPDX-License-Identifier: BSD-3-Clause
// Not a library's loops: a caller that waits for threads which the system does not let run, or that yields in a loop
// until they are, loses the machine to whatever else runs on it. The gain shows on overloaded machines only: a
// reconstruction takes 0.44 s against 0.47 s with OpenMP alone, 0.89 s against 1.85 s beside two endless loops on two
// cores (docs/benchmarks.md).
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <list>
#include <mutex>
#include <system_error>
#include <thread>
namespace fresco {
namespace {
std::atomic<int> default_threads{0};
using Clock = std::chrono::steady_clock;

thread_local bool at_work = false; ///< whether this thread is inside a chunk: a loop in it is run by this thread alone

/// About as long as it takes to wake a sleeping thread: who has waited that long had better sleep.
constexpr std::chrono::microseconds patience{50};

/// Until `done` says so or patience ends.
template <typename Done>
void waitBriefly(const Done& done)
{
  for (const auto end = Clock::now() + patience; !done() && Clock::now() <= end;) {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }
}

/// Threads that help whoever runs a loop. The caller works too and waits only for helpers that hold a chunk: one that
/// the system did not let run by then is not missed. Nobody spins for longer than a wake-up takes.
class ThreadPool {
public:
  /// The one of this process; never destroyed, since loops may run while the process ends.
  static ThreadPool& instance()
  {
    static auto* const pool = new ThreadPool;
    return *pool;
  }

  /// body(0) .. body(count - 1), each once, in any order, on the caller's and up to `threads` - 1 other threads; on
  /// fewer where the system has no more. The first exception of a chunk is thrown again here, the chunks not yet begun
  /// are left out then.
  void run(Index count, int threads, const std::function<void(Index)>& body)
  {
    Job job(count, threads, body);
    enlist(job, threads - 1);
    const std::exception_ptr thrown = job.takeChunks(0);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (job.wanted > 0) { // who comes now finds nothing to do
        jobs_.remove(&job);
        --waiting_jobs_;
      }
    }
    waitBriefly([&] { return job.helpers == 0; });
    std::unique_lock<std::mutex> lock(mutex_);
    job.idle.wait(lock, [&] { return job.helpers == 0; });
    if (thrown || job.error)
      std::rethrow_exception(thrown ? thrown : job.error);
  }

private:
  /// Every worker has a contiguous part of the chunks, so that two rarely work side by side in memory; who is through
  /// with its own goes on with the others'.
  struct Job {
    struct alignas(64) Part {
      std::atomic<Index> next{0};
      Index end = 0;
    };

    const std::function<void(Index)>& body;
    std::vector<Part> parts;
    int wanted = 0;              ///< helpers that may still join; guarded by the pool's mutex
    int joined = 0;              ///< helpers that did so far; guarded by the pool's mutex
    std::atomic<int> helpers{0}; ///< that work; rises only under the pool's mutex
    std::exception_ptr error;    ///< of a helper's chunk; guarded by the pool's mutex
    std::condition_variable idle;

    Job(Index count, int workers, const std::function<void(Index)>& loop) : body(loop), parts(workers)
    {
      for (int i = 0; i < workers; ++i) {
        parts[i].next = count * i / workers;
        parts[i].end = count * (i + 1) / workers;
      }
    }

    /// @param own which part to begin with. @returns the exception that ended the work of this thread, if any
    std::exception_ptr takeChunks(std::size_t own)
    {
      at_work = true;
      std::exception_ptr thrown;
      try {
        for (std::size_t i = 0; i < parts.size(); ++i) {
          Part& part = parts[(own + i) % parts.size()];
          for (Index chunk = part.next++; chunk < part.end; chunk = part.next++)
            body(chunk);
        }
      } catch (...) {
        thrown = std::current_exception();
        for (Part& part : parts)
          part.next = part.end;
      }
      at_work = false;
      return thrown;
    }
  };

  void enlist(Job& job, int helpers)
  {
    int wanted = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      try {
        for (; threads_ < helpers; ++threads_)
          std::thread([this] { help(); }).detach();
      } catch (const std::system_error&) { // no more threads to be had
      }
      job.wanted = wanted = std::min(helpers, threads_);
      if (wanted == 0)
        return;
      jobs_.push_back(&job);
      ++waiting_jobs_;
    }
    for (int i = 0; i < wanted; ++i)
      wake_.notify_one();
  }

  void help()
  {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      Job& job = *awaitJob(lock);
      const std::size_t own = job.joined;
      lock.unlock();
      const std::exception_ptr thrown = job.takeChunks(own);
      lock.lock();
      if (thrown && !job.error)
        job.error = thrown;
      if (--job.helpers == 0)
        job.idle.notify_one(); // the caller, if it sleeps, wakes once the mutex is free
    }
  }

  Job* awaitJob(std::unique_lock<std::mutex>& lock)
  {
    if (jobs_.empty()) {
      lock.unlock();
      waitBriefly([this] { return waiting_jobs_ > 0; });
      lock.lock();
      wake_.wait(lock, [this] { return !jobs_.empty(); });
    }
    Job* const job = jobs_.front();
    ++job->joined;
    ++job->helpers;
    if (--job->wanted == 0) {
      jobs_.pop_front();
      --waiting_jobs_;
    }
    return job;
  }

  std::mutex mutex_; ///< guards everything below and the members of jobs that say so
  std::condition_variable wake_;
  std::list<Job*> jobs_;             ///< that want helpers
  std::atomic<int> waiting_jobs_{0}; ///< length of jobs_, to be looked at without the mutex
  int threads_ = 0;
};
} // namespace

int threadCount(int threads)
{
  require(threads >= 0, "threads ", threads, " is negative");
  const int chosen = threads > 0 ? threads : default_threads.load();
  return chosen > 0 ? chosen : std::max<int>(1, std::thread::hardware_concurrency());
}

void setDefaultThreads(int threads)
{
  require(threads >= 0, "threads ", threads, " is negative");
  default_threads = threads;
}

namespace detail {
void runChunks(Index count, int threads, const std::function<void(Index)>& run)
{
  const int workers = std::min<Index>(threadCount(threads), count);
  if (workers > 1 && !at_work) {
    ThreadPool::instance().run(count, workers, run);
    return;
  }
  for (Index c = 0; c < count; ++c)
    run(c);
}
} // namespace detail
} // namespace fresco
