// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tools/tool_runs.h"
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <thread>
#include <unistd.h>
namespace fresco::test {
inline std::string binary(const std::string& name) { return buildFolder() + "/bin/fresco_" + name; }

/// A command, such as mpirun with what it starts.
class Job {
public:
  Job(const std::string& folder, const std::string& command) : log_(folder + "/.log.err")
  {
    process_ = fork();
    if (process_ != 0)
      return;
    dup2(open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    if (chdir(folder.c_str()) == 0)
      execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
    _exit(127);
  }

  /// Processes that it has started, rank 0 first; waits until there are `count`, or for ten seconds.
  std::vector<pid_t> children(std::size_t count) const
  {
    const std::string id = std::to_string(process_);
    std::vector<pid_t> found;
    for (int i = 0; i < 500 && found.size() < count; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      found.clear();
      std::ifstream list("/proc/" + id + "/task/" + id + "/children");
      for (pid_t child = 0; list >> child;)
        found.push_back(child);
    }
    return found;
  }

  int wait() const
  {
    int status = 0;
    waitpid(process_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  std::string said() const { return get(log_); }

private:
  std::string log_;
  pid_t process_ = 0;
};

inline Outcome runJob(const std::string& folder, const std::string& command)
{
  const Job job(folder, command);
  const int status = job.wait();
  return {status, "", job.said()};
}

/// @param command name of the program without fresco_, arguments
inline std::string ranks(int count, const std::string& command)
{
  return "mpirun -np " + std::to_string(count) + " " + binary(command);
}

/// Lines in which the program speaks.
inline std::vector<std::string> linesOf(const std::string& said)
{
  std::vector<std::string> lines;
  std::istringstream stream(said);
  for (std::string line; std::getline(stream, line);)
    if (line.rfind("fresco_", 0) == 0)
      lines.push_back(line);
  return lines;
}

inline bool lives(pid_t process)
{
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string id, name, state;
  return stat >> id >> name >> state && state != "Z";
}

/// Kills a rank of two after a while: both end, and only mpirun says something, with the rank.
inline void expectKilledRankEndsAll(const std::string& folder, const std::string& command, int victim, int milliseconds)
{
  const Job job(folder, ranks(2, command));
  const std::vector<pid_t> processes = job.children(2);
  ASSERT_EQ(processes.size(), 2U) << job.said();
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  kill(processes[victim], SIGKILL);
  EXPECT_NE(job.wait(), 0);
  for (int i = 0; i < 100 && lives(processes[1 - victim]); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(lives(processes[1 - victim]));
  EXPECT_TRUE(linesOf(job.said()).empty()) << job.said();
  EXPECT_NE(job.said().find("rank " + std::to_string(victim)), std::string::npos) << job.said();
}
} // namespace fresco::test
