// SPDX-License-Identifier: BSD-3-Clause
#include "cases/process.h"
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
namespace fresco::benchmark {
namespace {
double seconds(const timeval& time) { return time.tv_sec + 1e-6 * time.tv_usec; }

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// The words of a command as exec functions want them.
std::vector<char*> argumentVector(const std::vector<std::string>& command)
{
  std::vector<char*> arguments;
  for (const std::string& word : command)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

// SIGCHLD must be blocked, so that it can be waited for with a time limit.
sigset_t blockedChildSignal()
{
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGCHLD);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

int spawn(const std::vector<std::string>& command, const std::string& log, pid_t& child)
{
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  const int error =
      posix_spawnp(&child, command[0].c_str(), &actions, &attributes, argumentVector(command).data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

// @return whether the time was over
bool waitUntilOver(pid_t child, const sigset_t& signals, double end, int& status, rusage& usage)
{
  while (wait4(child, &status, WNOHANG, &usage) == 0) {
    const double left = end - now();
    if (end > 0 && left <= 0) {
      kill(child, SIGKILL);
      wait4(child, &status, 0, &usage);
      return true;
    }
    const double nap = end > 0 && left < 1.0 ? left : 1.0;
    const timespec time{static_cast<time_t>(nap),
                        static_cast<long>(1e9 * (nap - static_cast<double>(static_cast<time_t>(nap))))};
    sigtimedwait(&signals, nullptr, &time);
  }
  return false;
}

std::string failureText(int status, bool timed_out, const std::string& log)
{
  if (timed_out)
    return "time limit";
  if (WIFSIGNALED(status))
    return std::string("signal ") + strsignal(WTERMSIG(status));
  if (WEXITSTATUS(status) != 0)
    return "exit status " + std::to_string(WEXITSTATUS(status)) + ", see " + log;
  return "";
}
} // namespace

ProcessResult runProcess(const std::vector<std::string>& command, const std::string& log, const ProcessLimits& limits)
{
  ProcessResult result;
  const sigset_t signals = blockedChildSignal();
  const double start = now();
  pid_t child = 0;
  if (const int error = spawn(command, log, child); error != 0) {
    result.failure = command[0] + ": " + std::strerror(error);
    return result;
  }
  int status = 0;
  rusage usage{};
  const bool timed_out =
      waitUntilOver(child, signals, limits.timeout > 0 ? start + limits.timeout : 0.0, status, usage);
  result.wall = now() - start;
  result.cpu = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result.peak_memory = 1024.0 * usage.ru_maxrss;
  result.failure = failureText(status, timed_out, log);
  result.ok = result.failure.empty();
  return result;
}

void writeReport(std::FILE* file, const ProcessResult& result)
{
  std::fprintf(file, "%d %.9g %.9g %.17g %s\n", result.ok ? 1 : 0, result.wall, result.cpu, result.peak_memory,
               result.failure.c_str());
}

ProcessResult readReport(const std::string& path)
{
  ProcessResult result;
  int ok = 0;
  std::ifstream file(path);
  file >> ok >> result.wall >> result.cpu >> result.peak_memory;
  if (!file)
    return {false, "no report of the run", 0.0, 0.0, 0.0};
  result.ok = ok != 0;
  std::getline(file >> std::ws, result.failure);
  return result;
}
} // namespace fresco::benchmark
