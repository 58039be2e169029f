// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdio>
#include <string>
#include <vector>
namespace fresco::benchmark {
/// How a process ended and what it took.
struct ProcessResult {
  bool ok = false;        ///< exit status 0 within the time limit
  std::string failure;    ///< why not, one line
  double wall = 0;        ///< seconds
  double cpu = 0;         ///< seconds, user and system, of all its threads
  double peak_memory = 0; ///< bytes, largest resident set of the process
};

struct ProcessLimits {
  double timeout = 0; ///< seconds; 0 = none. The process is killed then
};

/// Runs a program without a shell and waits for it; what it prints goes to `log`.
/// @param command program and arguments; a program without '/' is looked up in PATH
ProcessResult runProcess(const std::vector<std::string>& command, const std::string& log,
                         const ProcessLimits& limits = {});

/// What fresco_benchmark_run hands over.
void writeReport(std::FILE* file, const ProcessResult& result);

/// What writeReport() wrote; a failure if there is no such file.
ProcessResult readReport(const std::string& path);
} // namespace fresco::benchmark
