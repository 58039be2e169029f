// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/inputs.h"
#include "io/points/file_window.h"
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fresco/io/file.h>
#include <fresco/io/files_read.h>
#include <map>
#include <mutex>
#include <optional>
#include <sys/stat.h>
namespace fresco {
namespace {
/// Files that were read, by device and number, with the name that was used first.
struct Inputs {
  std::mutex mutex;
  std::map<std::pair<dev_t, ino_t>, std::string> known;
};

Inputs& inputs()
{
  static auto* const all = new Inputs;
  return *all;
}

std::optional<std::pair<dev_t, ino_t>> identityOf(const std::string& path)
{
  struct stat found = {};
  if (::stat(path.c_str(), &found) != 0)
    return {};
  return std::pair(found.st_dev, found.st_ino);
}
} // namespace

void io::rememberInput(const std::string& path)
{
  if (const auto identity = identityOf(path)) {
    const std::lock_guard<std::mutex> lock(inputs().mutex);
    const auto [known, is_new] = inputs().known.emplace(*identity, path);
    if (!is_new && identityOf(known->second) != identity)
      known->second = path; // that file is gone, and its number was given to another one
  }
}

std::vector<std::string> filesRead()
{
  const std::lock_guard<std::mutex> lock(inputs().mutex);
  std::vector<std::string> paths;
  for (const auto& [identity, path] : inputs().known)
    paths.push_back(path);
  std::sort(paths.begin(), paths.end());
  return paths;
}

bool io::wasRead(const std::string& path)
{
  const auto identity = identityOf(path);
  const std::lock_guard<std::mutex> lock(inputs().mutex);
  return identity && inputs().known.count(*identity) > 0;
}

std::string io::reasonNotToOpen(const std::string& path)
{
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    return "no such file";
  if (std::filesystem::is_directory(path, error))
    return "is a folder, not a file";
  return std::filesystem::is_regular_file(path, error) ? "" : "is a device or a pipe, not a file";
}

std::string readFile(const std::string& path)
try {
  const io::RandomAccessFile file(path);
  std::string content(file.size(), '\0');
  file.read(0, content.data(), content.size());
  return content;
} catch (const std::runtime_error& error) {
  throw std::runtime_error(path + ": " + error.what());
}

std::string extension(const std::string& path)
{
  std::string text = std::filesystem::path(path).extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string fileBelow(const std::string& folder, const std::string& name)
{
  const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
  if (path.empty() || path.is_absolute() || *path.begin() == "..") {
    std::string shown = name.substr(0, 100);
    std::replace_if(
        shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    throw std::runtime_error((folder.empty() ? "." : folder) + ": names the file '" + shown +
                             "', which is not below its folder");
  }
  return (std::filesystem::path(folder) / path).string();
}
} // namespace fresco
