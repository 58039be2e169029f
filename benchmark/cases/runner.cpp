// SPDX-License-Identifier: BSD-3-Clause
#include "cases/runner.h"
#include "cases/process.h"
#include "cases/table.h"
#include <cctype>
#include <filesystem>
#include <fresco/io/file.h>
#include <nlohmann/json.hpp>
namespace fresco::benchmark {
namespace fs = std::filesystem;
namespace {
// `text` as part of a file name.
std::string fileName(std::string text)
{
  for (char& c : text)
    c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return text;
}

Accuracy readAccuracy(const std::string& file)
{
  const auto json = nlohmann::json::parse(readFile(file));
  const auto& distance = json.at("vertices").at("symmetric");
  const auto& mesh = json.at("mesh");
  return {distance.at("max_percent"), distance.at("mean_percent"),
          distance.at("rms_percent"), json.at("normals").at("mesh_to_reference").at("mean"),
          mesh.at("vertices"),        mesh.at("faces"),
          mesh.at("watertight")};
}
} // namespace

Runner::Runner(CaseTable table, RunnerOptions options, Log log)
    : table_(std::move(table)), options_(std::move(options)), log_(std::move(log))
{
  makeFolder(options_.cache);
  placeholders_ = {{"bin", options_.binaries},
                   {"source", options_.source},
                   {"data", options_.data},
                   {"cache", options_.cache},
                   {"threads", std::to_string(options_.threads)}};
}

// Through a small process of its own: see fresco_benchmark_run.
ProcessResult Runner::runMeasured(const Command& command, const std::string& log) const
{
  const std::string report = log + ".report";
  fs::remove(report);
  Command outer = {options_.binaries + "/fresco_benchmark_run", report, log, std::to_string(options_.timeout)};
  outer.insert(outer.end(), command.begin(), command.end());
  const ProcessResult started = runProcess(outer, options_.cache + "/run.log");
  return started.ok ? readReport(report) : started;
}

// "" if the program can be run, else the reason.
std::string Runner::whyAbsent(const Command& program, const Command& probe) const
{
  if (program[0].find('/') != std::string::npos && !fs::exists(program[0]))
    return "absent: there is no " + program[0];
  if (!probe.empty() && !runProcess(probe, options_.cache + "/probe.log").ok)
    return "absent: a probe failed (" + probe.back() + ")";
  return "";
}

// Makes the input unless the cache has it. "" if it is there, else the reason.
std::string Runner::makeInput(const std::string& name, std::string& path)
{
  const Input& input = table_.inputs.at(name);
  path = options_.cache + "/" + input.file;
  if (fs::exists(path))
    return "";
  for (const std::string& need : input.needs)
    if (const std::string file = substitute(need, placeholders_); !fs::exists(file))
      return "absent: there is no " + file;
  Placeholders placeholders = placeholders_;
  placeholders["output"] = path;
  for (const Command& pattern : input.commands) {
    const Command command = substitute(pattern, placeholders);
    if (const std::string absent = whyAbsent(command, {}); !absent.empty())
      return absent;
    log_("input " + name + ": " + command[0]);
    if (const ProcessResult made = runProcess(command, options_.cache + "/input_" + name + ".log"); !made.ok)
      return "absent: the input " + name + " could not be made: " + made.failure;
  }
  return fs::exists(path) ? "" : "absent: the input " + name + " was not written";
}

void Runner::measureAccuracy(const std::string& output, const std::string& reference, Measurement& m)
{
  const std::string figures = output + ".json";
  const Command command = {options_.binaries + "/fresco_compare", output, reference, "-json", figures};
  if (const ProcessResult compared = runProcess(command, output + ".compare.log"); !compared.ok)
    m.absent = "the output could not be compared: " + compared.failure;
  else
    m.accuracy = readAccuracy(figures);
}

Measurement Runner::measure(const Case& c, const Run& run, const std::string& input)
{
  Measurement m{c.name, run.peer, "", {}, 0.0, 0.0, {}};
  const std::string stem = options_.cache + "/" + fileName(c.name) + "_" + fileName(run.peer);
  Placeholders placeholders = placeholders_;
  placeholders["input"] = input;
  placeholders["output"] = stem + "." + c.extension;
  const Command command = substitute(run.command, placeholders);
  m.absent = whyAbsent(command, substitute(run.probe, placeholders));
  std::vector<double> cpu;
  for (int i = 0; i < options_.repeat && m.absent.empty(); ++i) {
    log_(c.name + ", " + run.peer + ", run " + std::to_string(i + 1) + " of " + std::to_string(options_.repeat));
    fs::remove(placeholders["output"]);
    const ProcessResult result = runMeasured(command, stem + ".log");
    m.wall.push_back(result.wall);
    cpu.push_back(result.cpu);
    m.peak_memory = std::max(m.peak_memory, result.peak_memory);
    if (!result.ok)
      m.absent = "failed: " + result.failure;
    else if (!fs::exists(placeholders["output"]))
      m.absent = "failed: no output";
  }
  m.cpu = median(cpu);
  if (m.absent.empty() && !c.reference.empty())
    measureAccuracy(placeholders["output"], substitute(c.reference, placeholders_), m);
  return m;
}

std::vector<Measurement> Runner::run(const Case& c)
{
  std::vector<Measurement> results;
  std::string input;
  const std::string absent = makeInput(c.input, input);
  for (const Run& run : c.runs)
    results.push_back(absent.empty() ? measure(c, run, input)
                                     : Measurement{c.name, run.peer, absent, {}, 0.0, 0.0, {}});
  return results;
}
} // namespace fresco::benchmark
