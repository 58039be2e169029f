// SPDX-License-Identifier: BSD-3-Clause
#include "job/file_state.h"
#include <fresco/core/require.h>
#include <fresco/io/byte_hash.h>
#include <fstream>
#include <optional>
#include <sys/stat.h>
#include <vector>
namespace fresco::model {
namespace {
using Json = nlohmann::ordered_json;
using std::chrono::system_clock;

std::optional<struct stat> lookedUp(const std::string& file)
{
  struct stat found = {};
  return ::stat(file.c_str(), &found) == 0 ? std::optional(found) : std::nullopt;
}

std::string statStamp(const struct stat& found)
{
  return concat(found.st_ino, " ", found.st_size, " ", found.st_ctim.tv_sec, ".", found.st_ctim.tv_nsec);
}

std::string contentHash(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    return "";
  std::vector<char> block(1 << 20);
  std::uint64_t hash = 0;
  while (stream.read(block.data(), std::streamsize(block.size())) || stream.gcount() > 0)
    hash = hashBytes(block.data(), stream.gcount(), hash);
  return concat(std::hex, hash);
}
} // namespace

std::string stampOf(const std::string& file)
{
  const auto found = lookedUp(file);
  return found ? statStamp(*found) : "";
}

Json stateOf(const std::string& file, system_clock::time_point since)
{
  constexpr std::chrono::seconds rest(2); // the coarsest clock of a file system: changes within it bear one time
  const auto found = lookedUp(file);
  if (!found)
    return "none";
  const system_clock::time_point changed(std::chrono::duration_cast<system_clock::duration>(
      std::chrono::seconds(found->st_ctim.tv_sec) + std::chrono::nanoseconds(found->st_ctim.tv_nsec)));
  const std::string hash = contentHash(file);
  if (changed >= since || hash.empty())
    return {};
  Json state{{"size", found->st_size}, {"hash", hash}};
  if (system_clock::now() - changed > rest)
    state["stamp"] = statStamp(*found);
  return state;
}

bool isAs(const Json& state, const std::string& file)
{
  const auto found = lookedUp(file);
  if (!found)
    return state == "none";
  if (!state.is_object() || state.at("size") != found->st_size)
    return false;
  return state.value("stamp", "") == statStamp(*found) || state.at("hash") == contentHash(file);
}
} // namespace fresco::model
