// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "support/args.h"
#include <cstdio>
#include <fresco/core/progress.h>
#include <functional>
namespace fresco {
/// Options that every tool has: -threads, -quiet.
struct CommonOptions {
  int threads = 0;
  bool quiet = false;
  void declare(Args& args);
};

/// Listener that draws a bar on a terminal and prints a plain line per step elsewhere, both on stderr; answers false
/// once the process has been asked to stop (SIGINT, SIGTERM). Silent where `quiet` is set.
Progress printProgress(bool quiet);

/// `text` as a line may show it: names and messages may come from files, and a terminal obeys control characters (C0, DEL,
/// and C1 as UTF-8 has them).
std::string oneLine(std::string text);

/// One line on stderr, unless `quiet`.
void inform(bool quiet, const std::string& line);

/// As std::printf() into a text of at most 255 bytes.
template <typename... Values>
std::string format(const char* pattern, Values... values)
{
  char line[256];
  std::snprintf(line, sizeof(line), pattern, values...);
  return line;
}

/// Runs `write`, which writes the last outputs of a tool: either all of them are there in the end and the process can
/// no longer be asked to stop, or none is.
void writeOutputs(const std::function<void()>& write);

/// For a program that is one of several processes of a job: how it ends where it cannot do its part.
struct JobEnd {
  std::string place; ///< of this process, behind each error: "rank 2 on HOST"; empty = the only one
  /// Ends all processes with a status, after one of them has spoken.
  std::function<void(int status, const std::function<void()>& say)> endAll;
};

/// To be called by the body of runTool(). From then on a process that is asked to stop ends without a word: what started
/// the job, such as mpirun, speaks and asks all of them.
void joinJob(JobEnd end);

/// Runs `body` and turns its end into an exit status: 0 done; 1 could not do it, with one line on stderr
/// "NAME: reason"; 2 wrong usage, with one line and a hint at -h. SIGINT, SIGTERM and SIGHUP ask `body` to stop; where
/// it does not within a third of a second, and where an exception leaves another thread, the process ends with 1 and
/// one line from there, after the unfinished files have been removed.
int runTool(const std::string& name, const std::function<void()>& body);
} // namespace fresco
