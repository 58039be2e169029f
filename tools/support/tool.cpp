// SPDX-License-Identifier: BSD-3-Clause
#include "support/tool.h"
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <fcntl.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/reading.h>
#include <fresco/io/unfinished_files.h>
#include <iostream>
#include <memory>
#include <mutex>
#include <new>
#include <set>
#include <sys/ioctl.h>
#include <system_error>
#include <thread>
#include <unistd.h>
extern "C" void __sanitizer_set_report_fd(void* descriptor) __attribute__((weak)); // NOLINT: not our name

namespace fresco {
std::string oneLine(std::string text)
{
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = [&](std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U; };
    if (byte(i) < 0x20 || byte(i) == 0x7f)
      text[i] = text[i] == '\n' || text[i] == '\r' || text[i] == '\t' ? ' ' : '?';
    else if (byte(i) == 0xc2 && byte(i + 1) >= 0x80 && byte(i + 1) < 0xa0)
      text.replace(i, 2, "?");
  }
  return text;
}

namespace {
std::atomic<int> own_stderr{STDERR_FILENO}; ///< where fresco prints; libraries know the other one only

/// What libraries print goes nowhere from now on.
void muteLibraries()
{
  const int kept = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (own_stderr == STDERR_FILENO && kept >= 0 && nowhere >= 0) {
    own_stderr = kept;
    if (__sanitizer_set_report_fd)
      __sanitizer_set_report_fd(reinterpret_cast<void*>(std::intptr_t{kept}));
    ::dup2(nowhere, STDERR_FILENO);
  }
  if (nowhere >= 0)
    ::close(nowhere);
}

std::atomic<int> stops_asked{0};
std::mutex ending;                      ///< held by whom decides whether the process ends half-way or with its outputs
std::atomic<bool> outputs_whole{false}; ///< only set while `ending` is held

bool mustStop() { return stops_asked > 0 && !outputs_whole; }

// The first signal asks to stop at the next step, the second at once; the third ends the process as usual.
void askToStop(int signal)
{
  if (++stops_asked > 1)
    std::signal(signal, SIG_DFL);
}

std::atomic<bool> bar_stands{false}; ///< the cursor is behind a bar, not at the start of a line

/// A line of its own on stderr, also where a bar stands. Neither locks nor allocates for the stream.
void printLine(const std::string& text)
{
  const std::string line = (bar_stands.exchange(false) ? "\n" : "") + oneLine(text) + "\n";
  for (std::size_t at = 0; at < line.size();) {
    const ssize_t written = ::write(own_stderr, line.data() + at, line.size() - at);
    if (written < 0 && errno != EINTR)
      return;
    at += std::max<ssize_t>(written, 0);
  }
}

std::string tool_name; ///< for what has no way to be told
JobEnd job_end;
std::atomic<bool> in_job{false}; ///< job_end is set

std::string errorLine(const std::string& reason)
{
  return tool_name + ": " + reason + (job_end.place.empty() ? "" : " (" + job_end.place + ")");
}

/// Ends the process without half files and without the memory being given back piece by piece.
[[noreturn]] void leave(const std::string& reason)
{
  abandonUnfinishedFiles();
  if (!reason.empty())
    printLine(errorLine(reason));
  _exit(1);
}

/// What is being thrown right now, in one line.
std::string reasonOfException(const std::string& otherwise)
{
  try {
    if (std::current_exception())
      throw;
  } catch (const std::bad_alloc&) {
    return "not enough memory";
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
  }
  return otherwise;
}

/// An exception left a thread of a library, or a destructor: nobody can catch it any more.
[[noreturn]] void endAfterUncaught() { leave(reasonOfException("ended by a library")); }

/// Ends the process where a step goes on for long after the user has asked to stop, without half files.
class Guard {
public:
  Guard()
  {
    try {
      thread_ = std::thread([this] { watch(); });
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
  void watch()
  {
    using namespace std::chrono_literals;
    std::unique_lock<std::mutex> lock(mutex_);
    const auto is_done = [this] { return done_ || outputs_whole; };
    while (!mustStop())
      if (wake_.wait_for(lock, 50ms, is_done))
        return;
    for (int i = 0; i < 6 && stops_asked == 1; ++i)
      if (wake_.wait_for(lock, 50ms, is_done))
        return;
    const std::lock_guard<std::mutex> end(ending);
    if (!outputs_whole)
      leave(in_job ? "" : "cancelled");
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::thread thread_;
};

std::string shownTime(double seconds)
{
  const long whole = std::max(1L, std::lround(seconds));
  return whole < 120 ? concat(whole, " s") : concat((whole + 30) / 60, " min");
}

/// Columns of the terminal on stderr.
std::size_t terminalWidth()
{
  winsize size{};
  return ioctl(own_stderr, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// A bar per job; a job begins where the fraction falls.
class Printer {
public:
  explicit Printer(bool quiet) : quiet_(quiet), terminal_(isatty(own_stderr) != 0) {}

  bool operator()(std::string_view step, double fraction)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!quiet_)
      print(std::string(step), std::clamp(fraction, 0.0, 1.0));
    return !mustStop();
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
    if (terminal_)
      drawBar(step);
    else if (step != last_)
      printLine(concat(step, " (", percent(), " %)"));
    last_ = step;
  }

  int percent() const // 100 is for what is done
  {
    return fraction_ < 1 ? std::min(99, static_cast<int>(std::lround(100 * fraction_))) : 100;
  }

  void drawBar(const std::string& step)
  {
    const std::size_t filled = percent() * 30 / 100;
    std::string line = concat('[', std::string(filled, '#'), std::string(30 - filled, '.'), "] ", percent(), " % ",
                              oneLine(step), remaining());
    if (const std::size_t most = terminalWidth() - 1; line.size() > most) // a bar of two lines could not be redrawn
      line.resize(most);
    line = "\r\033[K" + line + (fraction_ >= 1 ? "\n" : "");
    bar_stands = fraction_ < 1;
    [[maybe_unused]] const ssize_t written = ::write(own_stderr, line.data(), line.size());
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

namespace {
std::atomic<bool> is_quiet{false};

/// A line for each thing that readers remark, once: files may be read twice.
void hearReaders(const std::string& remark)
{
  static std::mutex mutex;
  static std::set<std::string> heard;
  const std::lock_guard<std::mutex> lock(mutex);
  if (heard.insert(remark).second)
    inform(is_quiet, "warning: " + remark);
}
} // namespace

void CommonOptions::declare(Args& args)
{
  listenToReaders(hearReaders);
  const Range range = Range::within(1, 4096).zero("all cores");
  args.values("threads", "N", "number of threads; never changes the result (" + range.text() + "; default 0)",
              [this, range](const auto& words) {
                threads = Args::integer("threads", words[0], range);
                setDefaultThreads(threads); // for what has no option of its own, such as readers
              });
  args.values("quiet", "", "print nothing but errors", [this](const auto&) {
    quiet = is_quiet = true;
    muteLibraries();
  });
}

Progress printProgress(bool quiet)
{
  const auto printer = std::make_shared<Printer>(quiet);
  return [printer](std::string_view step, double fraction) { return (*printer)(step, fraction); };
}

void inform(bool quiet, const std::string& line)
{
  if (!quiet)
    printLine(line);
}

void writeOutputs(const std::function<void()>& write)
{
  OutputGroup outputs;
  write();
  outputs.requireNoInputs();
  const std::lock_guard<std::mutex> lock(ending);
  outputs.commit();
  outputs_whole = true;
}

void joinJob(JobEnd end)
{
  job_end = std::move(end);
  in_job = true;
}

namespace {
/// What was printed on stdout is there, or that is an error. @return exit status
int finish()
{
  if (std::cout.flush())
    return 0;
  printLine(errorLine("standard output cannot be written"));
  return 1;
}

/// @return `status`, unless the whole job ends here
int fail(const std::string& line, int status)
{
  removeEmptyFolders();
  if (in_job)
    job_end.endAll(status, [&] { printLine(line); });
  printLine(line);
  return status;
}
} // namespace

int runTool(const std::string& name, const std::function<void()>& body)
try {
  tool_name = name;
  std::set_terminate(endAfterUncaught);
  for (const int stop : {SIGINT, SIGTERM})
    std::signal(stop, askToStop);
  if (std::signal(SIGHUP, askToStop) == SIG_IGN) // nohup
    std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN); // a file that grows beyond its limit is an error like a full disk
  const Guard guard;
  body();
  return finish();
} catch (const HelpShown&) {
  return finish();
} catch (const UsageError& error) {
  return fail(name + ": " + error.what() + " (see " + name + " -h)", 2);
} catch (...) {
  if (in_job && mustStop())
    leave("");
  return fail(errorLine(reasonOfException("unknown error")), 1);
}
} // namespace fresco
