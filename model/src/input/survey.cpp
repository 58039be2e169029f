// SPDX-License-Identifier: BSD-3-Clause
#include "input/survey.h"
#include <algorithm>
#include <filesystem>
#include <fnmatch.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/natural_order.h>
#include <map>
#include <sstream>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;

bool isOneOf(const std::string& extension, std::initializer_list<const char*> list)
{
  return std::any_of(list.begin(), list.end(), [&](const char* each) { return extension == each; });
}

bool isOfSort(const std::string& name, const std::string& sort, bool alone)
{
  const std::string kind = extension(name);
  if (sort == "<pictures>")
    return isOneOf(kind, {".jpg", ".jpeg", ".png", ".tif", ".tiff"});
  if (sort == "<depths>")
    return isOneOf(kind, {".png", ".tif", ".tiff", ".pfm", ".npy", ".exr"});
  if (sort == "<videos>")
    return isOneOf(kind, {".mp4", ".mov", ".avi", ".mkv", ".m4v", ".webm"});
  const bool notes =
      isOneOf(kind, {".txt", ".csv", ".stl"}); // poses, tables, models: scans only where nothing else is there
  return isReadable(name, FileKind::points) && (alone || !notes);
}

bool fits(const std::string& pattern, const std::string& name)
{
  return pattern.empty() == name.empty() && // '*' names a folder
         fnmatch(pattern.c_str(), name.c_str(), FNM_PATHNAME | FNM_CASEFOLD) == 0;
}

/// Splits "images/<pictures>" at the last '/'.
std::pair<std::string, std::string> parted(const std::string& name)
{
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? std::pair{std::string(), name}
                                    : std::pair{name.substr(0, slash), name.substr(slash + 1)};
}
} // namespace

Survey::Survey(std::string path) : path_(std::move(path)), folder_(path_)
{
  constexpr int levels = 3; // below the folder: keyframes/images/0.jpg of phones, dense/0/fused.ply of COLMAP
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (!fs::exists(status))
    throw std::runtime_error(
        path_ + ": " +
        (error && error != std::errc::no_such_file_or_directory ? error.message() : "no such file or folder"));
  is_file_ = !fs::is_directory(status);
  if (is_file_) {
    const fs::path file(path_);
    folder_ = file.has_parent_path() ? file.parent_path().string() : ".";
    files_ = {file.filename().string()};
    return;
  }
  fs::recursive_directory_iterator entry(path_, fs::directory_options::follow_directory_symlink, error), end;
  std::string last = path_;
  for (; !error && entry != end; entry.increment(error)) {
    last = entry->path().string();
    const std::string name = entry->path().lexically_relative(path_).string();
    const bool hidden = entry->path().filename().string()[0] == '.' || name == "__MACOSX";
    if (hidden || entry.depth() >= levels)
      entry.disable_recursion_pending();
    if (hidden || !entry->is_regular_file())
      continue;
    files_.push_back(name);
    for (std::string folder = parted(name).first; !folder.empty(); folder = parted(folder).first)
      folders_.insert(folder);
  }
  if (error)
    throw std::runtime_error(last + ": cannot be listed (" + error.message() +
                             "): give the right to read, as by chmod -R u+rX");
  std::sort(files_.begin(), files_.end(), isNaturallyBefore);
}

std::vector<std::string> Survey::match(const std::string& pattern) const
{
  std::istringstream alternatives(pattern);
  for (std::string wanted; std::getline(alternatives, wanted, '|');) {
    std::vector<std::string> names;
    if (wanted.find_first_of("*?[<") == std::string::npos && wanted.back() != '/') {
      if (holds(wanted))
        names = {wanted};
    } else if (wanted.back() == '/') {
      wanted.pop_back();
      std::copy_if(folders_.begin(), folders_.end(), std::back_inserter(names),
                   [&](const std::string& name) { return fits(wanted, name); });
    } else {
      const auto [folder, last] = parted(wanted);
      const bool of_sort = last[0] == '<';
      for (const std::string& name : files_)
        if (of_sort ? fits(folder, parted(name).first) && isOfSort(name, last, is_file_) : fits(wanted, name))
          names.push_back(name);
    }
    if (!names.empty())
      return names;
  }
  return {};
}

bool Survey::holds(const std::string& name) const
{
  return std::binary_search(files_.begin(), files_.end(), name, isNaturallyBefore);
}

std::vector<std::pair<std::string, int>> Survey::kinds() const
{
  std::map<std::string, int> counts;
  for (const std::string& file : files_)
    ++counts[extension(file)];
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

std::uintmax_t Survey::bytes(const std::string& name) const
{
  std::error_code error;
  const std::uintmax_t size = fs::file_size(at(name), error);
  return error ? 0 : size;
}

std::string counted(std::size_t count, const std::string& what)
{
  return concat(count, " ", what, count == 1 ? "" : "s");
}
} // namespace fresco::model
