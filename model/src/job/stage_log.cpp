// SPDX-License-Identifier: BSD-3-Clause
#include "job/stage_log.h"
#include "job/file_state.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/byte_hash.h>
#include <fresco/io/file.h>
#include <fresco/io/files_read.h>
#include <fresco/io/json_text.h>
#include <fstream>
#include <link.h>
#include <map>
#include <sys/resource.h>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Regular files below a folder with their stamps; hidden ones are nobody's output.
std::map<std::string, std::string> filesBelow(const std::string& folder)
{
  std::map<std::string, std::string> files;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().filename().string()[0] == '.')
      entry.disable_recursion_pending();
    else if (entry->is_regular_file())
      files[entry->path().lexically_relative(folder).string()] = stampOf(entry->path());
  return files;
}

/// Restarts the kernel's count of the highest resident memory.
void resetPeakMemory() { std::ofstream("/proc/self/clear_refs") << "5"; }

double peakMegabytes()
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0)
      return std::stod(line.substr(6)) / 1024.0;
  return 0;
}

/// Of this process and of programs that it ran and that have ended.
double cpuSeconds()
{
  double seconds = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(who, &used);
    for (const timeval& time : {used.ru_utime, used.ru_stime})
      seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return seconds;
}

StageRecord runMeasured(const Stage& stage, const Progress& progress)
{
  resetPeakMemory();
  const auto start = std::chrono::steady_clock::now();
  const double cpu_start = cpuSeconds();
  StageRecord record{stage.name, 0, 0, 0, false, stage.body(progress)};
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.cpu_seconds = cpuSeconds() - cpu_start;
  record.peak_megabytes = peakMegabytes();
  return record;
}

/// Processor time of all ranks, memory of the one that needed most.
void addCosts(StageRecord& record, Exchange& ranks)
{
  std::int64_t microseconds = std::llround(1e6 * record.cpu_seconds);
  ranks.sum(&microseconds, 1);
  record.cpu_seconds = 1e-6 * static_cast<double>(microseconds);
  ranks.largest(&record.peak_megabytes, 1);
}

/// What rank 0 knows, the others get to know.
bool tellRanks(bool known, Exchange& ranks)
{
  std::int64_t sum = ranks.rank() == 0 && known;
  ranks.sum(&sum, 1);
  return sum != 0;
}
} // namespace

std::vector<std::string> programFiles()
{
  std::error_code error;
  std::vector<std::string> files{std::filesystem::read_symlink("/proc/self/exe", error).string()};
  const auto add = [](dl_phdr_info* object, std::size_t, void* list) {
    const std::string path = object->dlpi_name;
    if (path.find("libfresco_") != std::string::npos)
      static_cast<std::vector<std::string>*>(list)->push_back(path);
    return 0;
  };
  dl_iterate_phdr(add, &files);
  return files;
}

StageLog::StageLog(std::string folder, const std::vector<std::string>& inputs, bool resume, Progress progress)
    : folder_(std::move(folder)), root_(fs::path(folder_).parent_path()), inputs_(inputs.begin(), inputs.end()),
      resume_(resume), progress_(std::move(progress))
{
  std::string names;
  for (const std::string& file : inputs_)
    if (!isOutput(file))
      names += file + "\n";
  key_ = std::to_string(hashBytes(names.data(), names.size()));
  for (const std::string& file : programFiles())
    inputs_.insert(file);
  makeFolder(folder_);
}

bool StageLog::isOutput(const std::string& file) const { return file.rfind(root_ + "/", 0) == 0; }

Json StageLog::inputsOfStage()
{
  for (const std::string& file : filesRead())
    inputs_.insert(file);
  Json states = Json::object();
  for (const std::string& file : inputs_)
    if (!isOutput(file) && recorded_.insert(file).second)
      states[file] = stateOf(file, start_);
  return states;
}

bool StageLog::takeOver(const Stage& stage, const std::string& file)
try {
  if (!resume_ || !fs::exists(file))
    return false;
  const Json stored = Json::parse(readFile(file), nullptr, false);
  if (stored.is_discarded() || !stored.is_object() || stored.value("key", "") != key_ || !stored.contains("figures"))
    return false;
  const Json outputs = stored.at("outputs"), inputs = stored.at("inputs");
  for (const auto& [name, state] : outputs.items())
    if (!isAs(state, root_ + "/" + name))
      return false;
  for (const auto& [name, state] : inputs.items())
    if (!isAs(state, name))
      return false;
  for (const std::string& path : stage.outputs) // nothing has come into its folders
    if (fs::is_directory(path))
      for (const auto& [name, stamp] : filesBelow(path))
        if (!outputs.contains(fs::path(path + "/" + name).lexically_relative(root_).string()))
          return false;
  for (const auto& [name, state] : inputs.items())
    recorded_.insert(name);
  records_.push_back({stage.name, stored.value("seconds", 0.0), stored.value("cpu_seconds", 0.0),
                      stored.value("peak_megabytes", 0.0), true, stored["figures"]});
  return true;
} catch (const std::exception&) { // empty, or a value of another type: not a record of ours
  return false;
}

void StageLog::renewReplaced(const Json& outputs) const
{
  for (const StageRecord& earlier : records_) {
    const std::string file = folder_ + "/" + earlier.name + ".json";
    Json record = Json::parse(readFile(file), nullptr, false);
    if (record.is_discarded() || !record.contains("outputs"))
      continue;
    const Json before = record["outputs"];
    for (const auto& [name, state] : before.items())
      if (outputs.contains(name))
        record["outputs"][name] = outputs[name];
      else if (!fs::exists(root_ + "/" + name))
        record["outputs"].erase(name);
    if (record["outputs"] != before)
      writeFile(file, jsonText(record, 2));
  }
}

void StageLog::run(const Stage& stage)
{
  const std::string words = key_ + "\n" + stage.name + "\n" + stage.options;
  key_ = std::to_string(hashBytes(words.data(), words.size()));
  const std::string file = folder_ + "/" + stage.name + ".json";
  report(progress_, stage.name, 0.0);
  const bool taken_over = takeOver(stage, file);
  if (stage.shared)
    tellRanks(taken_over, *ranks_);
  if (taken_over) {
    report(progress_, stage.name + ": taken from an earlier run", 1.0);
    return;
  }
  resume_ = false; // what follows depends on what is made anew here
  std::error_code error;
  std::filesystem::remove(file, error);
  const auto before = filesBelow(root_);
  StageRecord record = runMeasured(stage, [&](std::string_view step, double fraction) {
    return !progress_ || progress_(stage.name + ": " + std::string(step), std::min(fraction, 0.999));
  });
  if (stage.shared)
    addCosts(record, *ranks_);
  Json outputs = Json::object();
  for (const auto& [name, stamp] : filesBelow(root_))
    if (const auto old = before.find(name);
        fs::path(name).filename() != "log.txt" && (old == before.end() || old->second != stamp))
      outputs[name] = stateOf(root_ + "/" + name);
  writeFile(file, jsonText(Json{{"key", key_},
                                {"outputs", outputs},
                                {"inputs", inputsOfStage()},
                                {"seconds", record.seconds},
                                {"cpu_seconds", record.cpu_seconds},
                                {"peak_megabytes", record.peak_megabytes},
                                {"figures", record.figures}},
                           2));
  renewReplaced(outputs);
  records_.push_back(std::move(record));
  report(progress_, stage.name + ": done", 1.0);
}

void followStages(const std::vector<Stage>& stages, Exchange& ranks, const Progress& progress)
{
  for (const Stage& stage : stages)
    if (stage.shared && !tellRanks(false, ranks)) {
      StageRecord record = runMeasured(stage, progress);
      addCosts(record, ranks);
    }
}
} // namespace fresco::model
