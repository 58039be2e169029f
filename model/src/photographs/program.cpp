// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/program.h"
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fcntl.h>
#include <filesystem>
#include <fresco/core/require.h>
#include <fstream>
#include <poll.h>
#include <sstream>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
namespace fresco::model {
namespace {
constexpr int poll_milliseconds = 100; // a tool that was asked to stop has a third of a second

/// The environment, without a display: programs that would open a window for it do not.
std::vector<std::string> environmentWithoutDisplay()
{
  std::vector<std::string> all{"QT_QPA_PLATFORM=offscreen"};
  for (char** entry = environ; *entry; ++entry)
    if (std::strncmp(*entry, "QT_QPA_PLATFORM=", 16) != 0)
      all.emplace_back(*entry);
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& words)
{
  std::vector<char*> all;
  for (std::string& word : words)
    all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

/// A program in a process group of its own, which ends with this process, whatever ends that.
class Child {
public:
  explicit Child(std::vector<std::string> command)
  {
    std::vector<std::string> environment = environmentWithoutDisplay();
    const std::vector<char*> words = pointers(command), variables = pointers(environment);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw std::runtime_error(concat(command[0], ": ", std::strerror(errno)));
    process_ = fork();
    if (process_ == 0) { // only what is safe between fork and exec
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      setpgid(0, 0);
      const int nothing = open("/dev/null", O_RDONLY);
      dup2(nothing, STDIN_FILENO);
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      execve(words[0], words.data(), variables.data());
      _exit(127);
    }
    close(ends[1]);
    output_ = ends[0];
    if (process_ < 0) {
      close(output_);
      throw std::runtime_error(concat(command[0], ": ", std::strerror(errno)));
    }
    setpgid(process_, process_); // whoever of both comes first
  }
  ~Child()
  {
    if (output_ >= 0)
      close(output_);
    if (process_ > 0) {
      kill(-process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Waits a little for output; none comes any more once all that could write have closed it.
  void read(std::string& text)
  {
    pollfd waiting{output_, POLLIN, 0}; // nothing to wait for if negative, but the time
    if (poll(&waiting, 1, poll_milliseconds) <= 0)
      return;
    std::array<char, 4096> buffer{};
    const ssize_t count = ::read(output_, buffer.data(), buffer.size());
    if (count > 0)
      text.append(buffer.data(), static_cast<std::size_t>(count));
    else if (count == 0 || errno != EINTR)
      close(std::exchange(output_, -1));
  }

  /// What waits in the pipe, whoever may still hold its other end.
  void readRest(std::string& text) const
  {
    int waiting = 0;
    if (output_ < 0 || ioctl(output_, FIONREAD, &waiting) != 0)
      return;
    std::vector<char> buffer(waiting);
    const ssize_t count = ::read(output_, buffer.data(), buffer.size());
    text.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count)));
  }

  /// @return whether it has ended, and how; what it has left behind is killed then
  bool ended(int& status)
  {
    siginfo_t end = {};
    if (waitid(P_PID, process_, &end, WEXITED | WNOHANG | WNOWAIT) != 0 || end.si_pid != process_)
      return false;
    kill(-process_, SIGKILL); // while its number is still taken
    waitpid(process_, &status, 0);
    process_ = -1;
    return true;
  }

private:
  pid_t process_ = -1;
  int output_ = -1;
};

/// Takes whole lines off the front of `text`, and a line that does not end in pieces, so that it is not searched again and again.
template <typename Use>
void takeLines(std::string& text, const Use& use)
{
  constexpr std::size_t longest = std::size_t{1} << 16;
  for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1))
    use(text.substr(0, end));
  if (text.size() > longest) {
    use(text);
    text.clear();
  }
}
} // namespace

std::string findProgram(const std::string& name)
{
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const std::string file = folder + "/" + name;
        !folder.empty() && std::filesystem::is_regular_file(file) && access(file.c_str(), X_OK) == 0)
      return file;
  return "";
}

void runProgram(const std::vector<std::string>& command, const std::string& log,
                const std::function<void(const std::string&)>& hear, const std::function<void()>& stop)
{
  constexpr std::size_t kept = 3; // lines of an error
  std::ofstream file(log, std::ios::app);
  std::deque<std::string> last;
  const auto use = [&](const std::string& line) {
    file << line << "\n" << std::flush;
    if (line.find_first_not_of(" \t=") != std::string::npos)
      last.push_back(line);
    if (last.size() > kept)
      last.pop_front();
    hear(line);
  };
  Child child(command);
  std::string text;
  int status = 0;
  while (!child.ended(status)) {
    child.read(text);
    takeLines(text, use);
    stop();
  }
  child.readRest(text);
  takeLines(text, use);
  if (!text.empty()) // a last line without an end
    use(text);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return;
  std::string lines;
  for (const std::string& line : last)
    lines += " | " + line;
  throw std::runtime_error(concat(command[0], WIFSIGNALED(status) ? " was killed by signal " : " ended with ",
                                  WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status), " (its lines: ", log,
                                  ")", lines));
}
} // namespace fresco::model
