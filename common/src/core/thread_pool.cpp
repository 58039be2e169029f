// SPDX-License-Identifier: BSD-3-Clause
#include "core/thread_pool.h"
#include <algorithm>
#include <chrono>
#include <system_error>
#include <thread>
#include <vector>
namespace fresco {
namespace {
using Clock = std::chrono::steady_clock;

thread_local bool at_work = false;

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
} // namespace

/// Every worker has a contiguous part of the chunks, so that two rarely work side by side in memory; who is through
/// with its own goes on with the others'.
struct ThreadPool::Job {
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

  Job(Index count, int workers, const std::function<void(Index)>& loop)
      : body(loop), parts(static_cast<std::size_t>(workers))
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

ThreadPool& ThreadPool::instance()
{
  static auto* const pool = new ThreadPool;
  return *pool;
}

bool ThreadPool::isAtWork() { return at_work; }

void ThreadPool::run(Index count, int threads, const std::function<void(Index)>& body)
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

void ThreadPool::enlist(Job& job, int helpers)
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

ThreadPool::Job* ThreadPool::awaitJob(std::unique_lock<std::mutex>& lock)
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

void ThreadPool::help()
{
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    Job& job = *awaitJob(lock);
    const auto own = static_cast<std::size_t>(job.joined);
    lock.unlock();
    const std::exception_ptr thrown = job.takeChunks(own);
    lock.lock();
    if (thrown && !job.error)
      job.error = thrown;
    if (--job.helpers == 0)
      job.idle.notify_one(); // the caller, if it sleeps, wakes once the mutex is free
  }
}
} // namespace fresco
