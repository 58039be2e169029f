// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <string>
#include <vector>
namespace fresco::benchmark {
using Command = std::vector<std::string>;

/// A file that cases read, made once into the cache.
struct Input {
  std::string file;               ///< in the cache
  std::vector<Command> commands;  ///< that make it, in order
  std::vector<std::string> needs; ///< files that must exist, else the input is absent
};

/// One program that does the job of a case.
struct Run {
  std::string peer;
  Command command;
  Command probe; ///< must end with status 0, else the peer is absent; empty = nothing to probe
};

struct Case {
  std::string name, description;
  std::string input;     ///< name of an Input
  std::string reference; ///< mesh that the output is compared with; empty = accuracy not measured
  std::string extension; ///< of the output
  std::vector<Run> runs;
};

struct CaseTable {
  std::map<std::string, Input> inputs;
  std::vector<Case> cases;
};

/// Words in braces and what stands for them, such as {"data", "/path"}.
using Placeholders = std::map<std::string, std::string>;

/// `text` with every {name} that `placeholders` knows replaced.
std::string substitute(std::string text, const Placeholders& placeholders);
Command substitute(Command command, const Placeholders& placeholders);

/// @throws std::runtime_error naming the file if it is missing or malformed, or a case names an unknown input
CaseTable readCases(const std::string& path);
} // namespace fresco::benchmark
