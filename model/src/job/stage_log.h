// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/exchange.h>
#include <fresco/core/progress.h>
#include <functional>
#include <nlohmann/json.hpp>
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
  std::vector<std::string> outputs; ///< files; the stage is done when all are there
  std::function<nlohmann::ordered_json(const Progress&)> body; ///< returns its figures
  bool shared = false;                                         ///< all ranks take part; else rank 0 alone
};

/// Runs stages one after the other and keeps a record of each in `folder`, so that a later run can go on after the last
/// one that was finished with the same input and options.
class StageLog {
public:
  /// @param key      what the whole job depends on: the input
  /// @param progress hears of each stage from 0 to 1, steps as "STAGE: STEP"
  StageLog(std::string folder, const std::string& key, bool resume, Progress progress);

  /// This is the log of rank 0; the others call followStages().
  void shareWith(Exchange& ranks) { ranks_ = &ranks; }

  /// @throws what the stage throws
  void run(const Stage& stage);

  const std::vector<StageRecord>& records() const { return records_; }

private:
  bool takeOver(const Stage& stage, const std::string& file);
  std::string folder_, key_;
  bool resume_;
  Progress progress_;
  std::vector<StageRecord> records_;
  Exchange alone_;
  Exchange* ranks_ = &alone_;
};

/// Takes part in the shared stages among those that rank 0 runs. @throws what they throw
void followStages(const std::vector<Stage>& stages, Exchange& ranks, const Progress& progress);

/// Name, size and time of change of each file: changes when one of them does.
std::string fingerprint(const std::vector<std::string>& files);

/// The files that this program consists of: itself and the fresco libraries that it has loaded.
std::vector<std::string> programFiles();
} // namespace fresco::model
