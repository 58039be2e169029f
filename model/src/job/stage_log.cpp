// SPDX-License-Identifier: BSD-3-Clause
#include "job/stage_log.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/json_text.h>
#include <fstream>
#include <iomanip>
#include <link.h>
#include <sstream>
#include <sys/resource.h>
namespace fresco::model {
namespace {
using Json = nlohmann::ordered_json;

/// FNV-1a (Fowler, Noll, Vo), 64 bits, as hexadecimal text.
std::string hashed(const std::string& text)
{
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const unsigned char c : text)
    hash = (hash ^ c) * 0x100000001b3ULL;
  std::ostringstream out;
  out << std::hex << std::setw(16) << std::setfill('0') << hash;
  return out.str();
}

/// Those in folders too: where one is lost, the stage is not done.
std::ptrdiff_t fileCount(const std::vector<std::string>& outputs)
{
  std::ptrdiff_t count = 0;
  for (const std::string& path : outputs)
    count += std::filesystem::is_directory(path)
                 ? std::distance(std::filesystem::directory_iterator(path), std::filesystem::directory_iterator())
                 : std::ptrdiff_t{std::filesystem::exists(path)};
  return count;
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

std::string fingerprint(const std::vector<std::string>& files)
{
  std::ostringstream text;
  for (const std::string& file : files) {
    std::error_code error;
    text << file << " " << std::filesystem::file_size(file, error) << " "
         << std::filesystem::last_write_time(file, error).time_since_epoch().count() << "\n";
  }
  return text.str();
}

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

StageLog::StageLog(std::string folder, const std::string& key, bool resume, Progress progress)
    : folder_(std::move(folder)), key_(hashed(key)), resume_(resume), progress_(std::move(progress))
{
  makeFolder(folder_);
}

bool StageLog::takeOver(const Stage& stage, const std::string& file)
try {
  const auto exists = [](const std::string& path) { return std::filesystem::exists(path); };
  if (!resume_ || !exists(file) || !std::all_of(stage.outputs.begin(), stage.outputs.end(), exists))
    return false;
  const Json stored = Json::parse(readFile(file), nullptr, false);
  if (stored.is_discarded() || !stored.is_object() || stored.value("key", "") != key_ || !stored.contains("figures") ||
      stored.value("files", std::ptrdiff_t{0}) != fileCount(stage.outputs))
    return false;
  records_.push_back({stage.name, stored.value("seconds", 0.0), stored.value("cpu_seconds", 0.0),
                      stored.value("peak_megabytes", 0.0), true, stored["figures"]});
  return true;
} catch (const Json::exception&) { // a value of another type: not a record of ours
  return false;
}

void StageLog::run(const Stage& stage)
{
  key_ = hashed(key_ + "\n" + stage.name + "\n" + stage.options);
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
  StageRecord record = runMeasured(stage, [&](std::string_view step, double fraction) {
    return !progress_ || progress_(stage.name + ": " + std::string(step), std::min(fraction, 0.999));
  });
  if (stage.shared)
    addCosts(record, *ranks_);
  writeFile(file, jsonText(Json{{"key", key_},
                                {"files", fileCount(stage.outputs)},
                                {"seconds", record.seconds},
                                {"cpu_seconds", record.cpu_seconds},
                                {"peak_megabytes", record.peak_megabytes},
                                {"figures", record.figures}},
                           2));
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
