// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>
namespace fresco::model {
/// What lies in a folder and the three levels below it: names, nothing of the contents. A file is taken as a folder of that one
/// file. Hidden files and folders are left out.
class Survey {
public:
  /// @throws std::runtime_error naming what is not there or may not be listed
  explicit Survey(std::string path);

  const std::string& path() const { return path_; }
  bool isFile() const { return is_file_; }
  /// Path of what match() named.
  std::string at(const std::string& name) const { return folder_ + "/" + name; }

  /// Names that fit, relative to the folder, numbers in them compared as numbers. Of alternatives ("color/|rgb/") the first
  /// that anything fits. "NAME/" is a folder with something in it; "*" stands for any part of one name, in either case;
  /// "<points>", "<pictures>", "<depths>" and "<videos>" for the files of that sort, which may stand below folders: "images/<pictures>".
  std::vector<std::string> match(const std::string& pattern) const;
  bool has(const std::string& pattern) const { return !match(pattern).empty(); }
  bool holds(const std::string& name) const; ///< that file: names that files tell are no patterns

  /// Sorts of files and how many there are, the most frequent first.
  std::vector<std::pair<std::string, int>> kinds() const;
  const std::vector<std::string>& files() const { return files_; }
  const std::set<std::string>& folders() const { return folders_; }
  std::uintmax_t bytes(const std::string& name) const; ///< of a file

private:
  std::string path_, folder_;
  bool is_file_ = false;
  std::vector<std::string> files_; ///< in natural order
  std::set<std::string> folders_;  ///< without those that are empty
};

/// "1 photograph", "24 photographs".
std::string counted(std::size_t count, const std::string& what);
} // namespace fresco::model
