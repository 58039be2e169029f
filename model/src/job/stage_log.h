// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <fresco/core/exchange.h>
#include <fresco/core/progress.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>
namespace fresco::model {
/// What a stage cost and what it found out.
struct StageRecord {
  std::string name;
  double seconds = 0;        ///< wall clock
  double cpu_seconds = 0;    ///< of all threads, and of programs that were run
  double peak_megabytes = 0; ///< resident memory of the process, highest during the stage
  bool resumed = false;      ///< taken over from an earlier run
  nlohmann::ordered_json figures;
};

/// One step of the job: reads files, writes files.
struct Stage {
  std::string name;
  std::string options;              ///< everything besides the stages before that the outputs depend on
  std::vector<std::string> outputs; ///< files and folders that it must leave; others that it writes are found
  std::function<nlohmann::ordered_json(const Progress&)> body; ///< returns its figures
  bool shared = false;                                         ///< all ranks take part; else rank 0 alone
};

/// Runs stages one after the other and keeps a record of each in `folder`, so that a later run can go on after the last
/// one that was finished with the same options. Nothing is believed because it exists: a record holds the state of every
/// file below the folder's parent that the stage wrote, and of every other file that the process had read by then, and is good
/// only while all of them are as they were.
class StageLog {
public:
  /// @param inputs   files that the job reads as far as is known; those that the library reads besides are found
  /// @param progress hears of each stage from 0 to 1, steps as "STAGE: STEP"
  StageLog(std::string folder, const std::vector<std::string>& inputs, bool resume, Progress progress);

  /// This is the log of rank 0; the others call followStages().
  void shareWith(Exchange& ranks) { ranks_ = &ranks; }

  /// @throws what the stage throws
  void run(const Stage& stage);

  const std::vector<StageRecord>& records() const { return records_; }

private:
  bool takeOver(const Stage& stage, const std::string& file);
  /// Outputs of earlier stages that a later one has changed, such as a database that grows, or taken away: all of these stages
  /// are to be done again where they are not as that one left them.
  void renewReplaced(const nlohmann::ordered_json& outputs) const;
  bool isOutput(const std::string& file) const;
  nlohmann::ordered_json inputsOfStage(); ///< states of the inputs that no earlier record has
  std::string folder_, key_;
  std::string root_; ///< below which outputs lie
  std::set<std::string> inputs_, recorded_;
  std::chrono::system_clock::time_point start_ = std::chrono::system_clock::now();
  bool resume_;
  Progress progress_;
  std::vector<StageRecord> records_;
  Exchange alone_;
  Exchange* ranks_ = &alone_;
};

/// Takes part in the shared stages among those that rank 0 runs. @throws what they throw
void followStages(const std::vector<Stage>& stages, Exchange& ranks, const Progress& progress);

/// The files that this program consists of: itself and the fresco libraries that it has loaded.
std::vector<std::string> programFiles();
} // namespace fresco::model
