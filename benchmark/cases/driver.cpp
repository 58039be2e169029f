// SPDX-License-Identifier: BSD-3-Clause
#include "cases/machine.h"
#include "cases/runner.h"
#include "cases/table.h"
#include "support/tool.h"
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fresco/io/file.h>
#include <iostream>
namespace {
using namespace fresco;
using namespace fresco::benchmark;

struct Options {
  RunnerOptions runner;
  std::string cases = FRESCO_SOURCE_DIR "/benchmark/cases/cases.json", markdown, json;
  std::vector<std::string> names;
  CommonOptions common;
  bool list = false;
};

std::string defaultData()
{
  const char* given = std::getenv("FRESCO_DATA");
  return given ? given : std::string(FRESCO_SOURCE_DIR) + "/../shared/data";
}

Options parse(int argc, char** argv)
{
  Options options;
  RunnerOptions& runner = options.runner;
  runner.source = FRESCO_SOURCE_DIR;
  runner.binaries = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
  runner.data = defaultData();
  runner.cache = runner.binaries + "/../benchmark_cache";
  Args args(
      "fresco_benchmark [CASE...] [options]",
      "Runs the named cases (all without a name), each program as its own process, and prints a markdown table of\n"
      "wall and CPU time, peak memory and accuracy. Peers that are not installed are said to be absent.");
  args.option("repeat", runner.repeat, Range::atLeast(1), "runs of each program");
  args.option("timeout", runner.timeout, Range::above(0).zero("no limit"), "seconds a run may take");
  args.option("cases", options.cases, "table of cases");
  args.option("data", runner.data, "folder of real data; the environment variable FRESCO_DATA sets the default");
  args.option("cache", runner.cache, "folder for inputs, made once, and outputs");
  args.option("out", options.markdown, "file for the table, beside standard output");
  args.option("json", options.json, "file for all figures");
  args.flag("list", options.list, "print the names of the cases");
  options.common.declare(args);
  options.names = args.parse(argc, argv, 0, 1000);
  if (runner.repeat < 1 || runner.timeout < 0 || options.common.threads < 0)
    throw UsageError("-repeat wants 1 or more, -timeout and -threads 0 or more");
  runner.threads = options.common.threads;
  return options;
}

std::vector<Case> chosenCases(const CaseTable& table, const std::vector<std::string>& names)
{
  if (names.empty())
    return table.cases;
  std::vector<Case> chosen;
  for (const std::string& name : names) {
    const auto found =
        std::find_if(table.cases.begin(), table.cases.end(), [&](const Case& c) { return c.name == name; });
    if (found == table.cases.end())
      throw UsageError("there is no case " + name + " (see -list)");
    chosen.push_back(*found);
  }
  return chosen;
}

std::string heading(const std::vector<Case>& cases, const RunnerOptions& options)
{
  std::string text = machineText() + "- runs of each program: " + std::to_string(options.repeat) + "\n";
  for (const Case& c : cases)
    text += "- " + c.name + ": " + c.description + "\n";
  return text + "\n";
}

void writeFiles(const Options& options, const std::string& text, const std::vector<Measurement>& measurements)
{
  if (!options.markdown.empty())
    writeFile(options.markdown, text);
  if (!options.json.empty())
    writeFile(options.json, measurementsJson(measurements).dump(1) + "\n");
}

void run(const Options& options)
{
  const CaseTable table = readCases(options.cases);
  const std::vector<Case> cases = chosenCases(table, options.names);
  if (options.list) {
    for (const Case& c : cases)
      std::cout << c.name << ": " << c.description << "\n";
    return;
  }
  const std::string head = heading(cases, options.runner);
  const Progress progress = printProgress(options.common.quiet);
  double done = 0.0;
  const auto log = [&](const std::string& line) { report(progress, line, done / cases.size()); };
  Runner runner(table, options.runner, log);
  std::vector<Measurement> measurements;
  for (const Case& c : cases) {
    for (Measurement& m : runner.run(c))
      measurements.push_back(std::move(m));
    done += 1.0;
    writeFiles(options, head + markdownTable(measurements), measurements); // a stopped job leaves what it has
  }
  std::cout << head << markdownTable(measurements) << std::flush;
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_benchmark", [&] { run(parse(argc, argv)); });
}
