// SPDX-License-Identifier: BSD-3-Clause
#include "cases/cases.h"
#include <fresco/io/file.h>
#include <nlohmann/json.hpp>
#include <stdexcept>
namespace fresco::benchmark {
namespace {
using nlohmann::json;

Input readInput(const json& entry)
{
  return {entry.at("file"), entry.at("commands").get<std::vector<Command>>(),
          entry.value("needs", std::vector<std::string>())};
}

Case readCase(const json& entry, const json& peers)
{
  Case result{entry.at("name"),
              entry.at("description"),
              entry.at("input"),
              entry.value("reference", ""),
              entry.value("extension", "ply"),
              {}};
  for (const json& run : entry.at("runs")) {
    const std::string peer = run.at("peer");
    Command command = peers.at(peer).at("command").get<Command>();
    for (const std::string& option : run.value("options", Command()))
      command.push_back(option);
    result.runs.push_back({run.value("label", peer), command, peers.at(peer).value("probe", Command())});
  }
  return result;
}
} // namespace

std::string substitute(std::string text, const Placeholders& placeholders)
{
  for (const auto& [name, value] : placeholders) {
    const std::string word = "{" + name + "}";
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + value.size()))
      text.replace(at, word.size(), value);
  }
  return text;
}

Command substitute(Command command, const Placeholders& placeholders)
{
  for (std::string& word : command)
    word = substitute(word, placeholders);
  return command;
}

CaseTable readCases(const std::string& path)
try {
  const json root = json::parse(readFile(path));
  CaseTable table;
  for (const auto& [name, entry] : root.at("inputs").items())
    table.inputs[name] = readInput(entry);
  for (const json& entry : root.at("cases")) {
    table.cases.push_back(readCase(entry, root.at("peers")));
    if (table.inputs.count(table.cases.back().input) == 0)
      throw std::runtime_error("case " + table.cases.back().name + " names an unknown input");
  }
  return table;
} catch (const std::exception& error) {
  throw std::runtime_error(path + ": " + error.what());
}
} // namespace fresco::benchmark
