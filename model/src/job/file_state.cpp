// SPDX-License-Identifier: BSD-3-Clause
#include "job/file_state.h"
#include <cstdint>
#include <cstring>
#include <fresco/core/require.h>
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

std::string stampOf(const struct stat& found)
{
  return concat(found.st_ino, " ", found.st_size, " ", found.st_ctim.tv_sec, ".", found.st_ctim.tv_nsec);
}

/// Eight bytes at a time. For a given word the steps are one to one in the hash, and for a given hash in the word.
class Hash {
public:
  /// @param room for up to seven bytes more behind the end
  void add(char* data, std::size_t size)
  {
    std::memset(data + size, 0, (8 - size % 8) % 8);
    for (std::size_t i = 0; i < size; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, data + i, 8);
      value_ = (value_ ^ word) * 0x9e3779b97f4a7c15ULL; // odd: 2^64 divided by the golden ratio
      value_ ^= value_ >> 32;
    }
  }
  std::string text() const { return concat(std::hex, value_); }

private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

std::string contentHash(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    return "";
  std::vector<char> block(1 << 20);
  Hash hash;
  while (stream.read(block.data(), std::streamsize(block.size())) || stream.gcount() > 0)
    hash.add(block.data(), stream.gcount());
  return hash.text();
}
} // namespace

std::string stampOf(const std::string& file)
{
  const auto found = lookedUp(file);
  return found ? stampOf(*found) : "";
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
    state["stamp"] = stampOf(*found);
  return state;
}

bool isAs(const Json& state, const std::string& file)
{
  const auto found = lookedUp(file);
  if (!found)
    return state == "none";
  if (!state.is_object() || state.at("size") != found->st_size)
    return false;
  return state.value("stamp", "") == stampOf(*found) || state.at("hash") == contentHash(file);
}

std::string hashOf(const std::string& text)
{
  Hash hash;
  std::string padded = text + std::string(8, '\0');
  hash.add(padded.data(), text.size());
  return concat(text.size(), " ", hash.text());
}
} // namespace fresco::model
