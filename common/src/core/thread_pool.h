// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <atomic>
#include <condition_variable>
#include <exception>
#include <fresco/core/types.h>
#include <functional>
#include <list>
#include <mutex>
namespace fresco {
/// Threads that help whoever runs a loop. The caller works too and waits only for helpers that hold a chunk: one that
/// the system did not let run by then is not missed. Nobody spins for longer than a wake-up takes.
class ThreadPool {
public:
  /// The one of this process; never destroyed, since loops may run while the process ends.
  static ThreadPool& instance();

  /// Whether this thread is inside a chunk: a loop in it is run by this thread alone.
  static bool isAtWork();

  /// body(0) .. body(count - 1), each once, in any order, on the caller's and up to `threads` - 1 other threads; on
  /// fewer where the system has no more. The first exception of a chunk is thrown again here, the chunks not yet begun
  /// are left out then.
  void run(Index count, int threads, const std::function<void(Index)>& body);

private:
  struct Job;
  void enlist(Job& job, int helpers);
  void help();
  Job* awaitJob(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_; ///< guards everything below and the members of jobs that say so
  std::condition_variable wake_;
  std::list<Job*> jobs_;             ///< that want helpers
  std::atomic<int> waiting_jobs_{0}; ///< length of jobs_, to be looked at without the mutex
  int threads_ = 0;
};
} // namespace fresco
