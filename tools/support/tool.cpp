// SPDX-License-Identifier: BSD-3-Clause
#include "support/tool.h"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
#include <fresco/common/unfinished_files.h>
#include <iostream>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <unistd.h>
namespace fresco {
namespace {
std::atomic<bool> stop_asked{false};

// The first signal asks to stop at the next step; the second ends the process as usual.
void askToStop(int signal)
{
  stop_asked = true;
  std::signal(signal, SIG_DFL);
}

/// Ends the process where a step goes on for long after the user has asked to stop, without half files.
class Guard {
public:
  explicit Guard(const std::string& name)
  {
    try {
      thread_ = std::thread([this, name] { watch(name); });
    } catch (const std::system_error&) { // no thread to be had: a step then ends when it ends
    }
  }
  ~Guard()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      done_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable())
      thread_.join();
  }
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

private:
  void watch(const std::string& name)
  {
    using namespace std::chrono_literals;
    std::unique_lock<std::mutex> lock(mutex_);
    const auto is_done = [this] { return done_; };
    while (!stop_asked)
      if (wake_.wait_for(lock, 100ms, is_done))
        return;
    if (wake_.wait_for(lock, 500ms, is_done))
      return;
    abandonUnfinishedFiles();
    const std::string line = name + ": cancelled\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
    _exit(1);
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::thread thread_;
};

std::string oneLine(std::string text)
{
  for (char& c : text)
    if (c == '\n' || c == '\r')
      c = ' ';
  return text;
}

std::string shownTime(double seconds)
{
  const auto whole = static_cast<long>(std::lround(seconds));
  return whole < 120 ? concat(whole, " s") : concat((whole + 30) / 60, " min");
}

/// A bar per job; a job begins where the fraction falls.
class Printer {
public:
  explicit Printer(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

  bool operator()(std::string_view step, double fraction)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!quiet_)
      print(std::string(step), std::clamp(fraction, 0.0, 1.0));
    return !stop_asked;
  }

private:
  using Clock = std::chrono::steady_clock;

  void print(const std::string& step, double fraction)
  {
    if (fraction < fraction_) {
      start_ = Clock::now();
      last_.clear();
    }
    fraction_ = fraction;
    const int percent = static_cast<int>(std::lround(100 * fraction));
    if (terminal_) {
      const int filled = percent * 30 / 100;
      std::cerr << "\r\033[K[" << std::string(static_cast<std::size_t>(filled), '#')
                << std::string(static_cast<std::size_t>(30 - filled), '.') << "] " << percent << " % " << step
                << remaining() << (fraction >= 1 ? "\n" : "") << std::flush;
    } else if (step != last_) {
      std::cerr << step << " (" << percent << " %)\n";
    }
    last_ = step;
  }

  /// Time left if the rest goes on as fast as what is done; nothing while that would be a guess.
  std::string remaining() const
  {
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    if (fraction_ < 0.05 || fraction_ >= 1 || elapsed < 2)
      return "";
    return ", " + shownTime(elapsed * (1 - fraction_) / fraction_) + " left";
  }

  bool quiet_, terminal_;
  double fraction_ = 0;
  Clock::time_point start_ = Clock::now();
  std::string last_;
  std::mutex mutex_;
};
} // namespace

void CommonOptions::declare(Args& args)
{
  args.values("threads", "N", "number of threads, 0 = all cores; never changes the result (default 0)",
              [this](const auto& words) {
                const long long given = Args::integer("threads", words[0]);
                if (given < 0 || given > 4096)
                  throw UsageError("option -threads: " + words[0] + " is not within 0 and 4096");
                threads = static_cast<int>(given);
                setDefaultThreads(threads); // for what has no option of its own, such as readers
              });
  args.flag("quiet", quiet, "print nothing but errors");
}

Progress printProgress(bool quiet)
{
  const auto printer = std::make_shared<Printer>(quiet);
  return [printer](std::string_view step, double fraction) { return (*printer)(step, fraction); };
}

void inform(bool quiet, const std::string& line)
{
  if (!quiet)
    std::cerr << line << std::endl;
}

int runTool(const std::string& name, const std::function<void()>& body)
try {
  std::signal(SIGINT, askToStop);
  std::signal(SIGTERM, askToStop);
  std::signal(SIGXFSZ, SIG_IGN); // a file that grows beyond its limit is an error like a full disk
  const Guard guard(name);
  body();
  return 0;
} catch (const HelpShown&) {
  return 0;
} catch (const UsageError& error) {
  std::cerr << name << ": " << oneLine(error.what()) << " (see " << name << " -h)\n";
  return 2;
} catch (const std::bad_alloc&) {
  std::cerr << name << ": not enough memory\n";
  return 1;
} catch (const std::exception& error) {
  std::cerr << name << ": " << oneLine(error.what()) << "\n";
  return 1;
}
} // namespace fresco
