// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "cases/cases.h"
#include "cases/process.h"
#include <functional>
#include <optional>
#include <string>
#include <vector>
namespace fresco::benchmark {
struct RunnerOptions {
  std::string binaries; ///< folder of fresco's programs
  std::string source;   ///< folder of the project's sources
  std::string data;     ///< folder of real data
  std::string cache;    ///< folder for inputs and outputs
  int threads = 0;      ///< handed to every peer, 0 = all cores
  int repeat = 1;       ///< runs of each peer, >= 1
  double timeout = 0;   ///< seconds a run may take, 0 = no limit
};

/// Distances in % of the diagonal of the reference's bounding box, symmetric.
struct Accuracy {
  double max = 0, mean = 0, rms = 0;
  double normals = 0; ///< mean angle between normals of output and reference, degrees
  long vertices = 0, faces = 0;
  bool watertight = false;
};

struct Measurement {
  std::string case_name, peer;
  std::string absent;       ///< why there is nothing, or why the run failed; empty = measured
  std::vector<double> wall; ///< seconds, one per repetition
  double cpu = 0;           ///< seconds, median
  double peak_memory = 0;   ///< bytes, largest
  std::optional<Accuracy> accuracy;
};

/// Runs cases, each run as its own process; makes missing inputs first. What programs print goes to files in the cache.
class Runner {
public:
  using Log = std::function<void(const std::string& line)>;
  Runner(CaseTable table, RunnerOptions options, Log log);

  std::vector<Measurement> run(const Case& c);

private:
  std::string makeInput(const std::string& name, std::string& path);
  std::string whyAbsent(const Command& program, const Command& probe) const;
  ProcessResult runMeasured(const Command& command, const std::string& log) const;
  Measurement measure(const Case& c, const Run& run, const std::string& input);
  void measureAccuracy(const std::string& output, const std::string& reference, Measurement& m);

  CaseTable table_;
  RunnerOptions options_;
  Log log_;
  Placeholders placeholders_;
};
} // namespace fresco::benchmark
