// SPDX-License-Identifier: BSD-3-Clause
// fresco_benchmark_run REPORT LOG TIMEOUT PROGRAM ARGUMENT...: runs a program and writes what it took to REPORT. The
// kernel counts the memory of the process that starts another one to the started one's peak; so this one is small,
// without libraries.
#include "cases/process.h"
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv)
{
  using namespace fresco::benchmark;
  if (argc < 5) {
    std::fprintf(stderr, "usage: fresco_benchmark_run REPORT LOG TIMEOUT PROGRAM ARGUMENT...\n");
    return 2;
  }
  const ProcessResult result = runProcess({argv + 4, argv + argc}, argv[2], {std::atof(argv[3])});
  std::FILE* report = std::fopen(argv[1], "w");
  if (report == nullptr)
    return 1;
  writeReport(report, result);
  return std::fclose(report) == 0 ? 0 : 1;
}
