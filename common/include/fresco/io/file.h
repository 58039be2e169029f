// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/export.h>
#include <string>
#include <string_view>
namespace fresco {
/// An output that is whole or absent: written beside its name (`.STEM.RANDOM.part.EXTENSION` in the same folder),
/// flushed, then renamed. Destroyed without commit(): nothing remains and an older file of that name is untouched. Of
/// several processes with one output the last one to commit wins. The new file has the mode bits of the one that it
/// replaces. What a process that was killed left beside the name is removed.
class FRESCO_EXPORT OutputFile {
public:
  /// @throws std::runtime_error naming the file and the reason if the folder is missing or not writable, or if `path` is
  ///         a folder, a link, a device or a pipe
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where a library that wants a file name writes; it then does not call write().
  const std::string& temporaryPath() const { return temporary_; }

  /// Buffered append. @throws std::runtime_error naming the file and the reason (disk full ...)
  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// @throws std::runtime_error naming the file and the reason; nothing is left behind then
  void commit();

private:
  void flush();
  void store(const char* from, std::size_t bytes);
  void send(); // lets the disk begin with what was written, waits for what was sent the time before
  std::string path_, temporary_, buffer_;
  std::size_t written_ = 0, sent_ = 0, awaited_ = 0; // bytes from the start of the file, in falling order
  int descriptor_ = -1;
};

/// Outputs that belong together: while one exists, commit() of an OutputFile of its thread stores the file, and commit()
/// of the group gives all of them their names at once. Destroyed without commit(): none of them remains. One at a time;
/// the files of other threads do not belong to it.
class FRESCO_EXPORT OutputGroup {
public:
  OutputGroup();
  ~OutputGroup();
  OutputGroup(const OutputGroup&) = delete;
  OutputGroup& operator=(const OutputGroup&) = delete;

  /// @throws std::runtime_error naming the file if one of them would replace a file that readFile() has read
  void requireNoInputs() const;

  /// @throws std::runtime_error naming the file and the reason; those that have their name by then keep it
  void commit();
};

/// Whole content. @throws std::runtime_error naming the file if it is missing, no regular file, empty or unreadable
FRESCO_EXPORT std::string readFile(const std::string& path);

/// The whole content at once; see OutputFile. @throws std::runtime_error as OutputFile
FRESCO_EXPORT void writeFile(const std::string& path, std::string_view content);

/// Extension in lower case with its dot, "" if none.
FRESCO_EXPORT std::string extension(const std::string& path);

/// Path of the file `name` that a file in `folder` names. @throws std::runtime_error if it lies elsewhere: files from
/// strangers must not make a program read what is not theirs
FRESCO_EXPORT std::string fileBelow(const std::string& folder, const std::string& name);

/// Creates a folder and its parents. @throws std::runtime_error naming it if that fails or it cannot be written to
FRESCO_EXPORT void makeFolder(const std::string& path);

/// Keeps a folder for one process until it is destroyed or the process ends, by flock().
class FRESCO_EXPORT FolderLock {
public:
  /// @param program for the message. @throws std::runtime_error "FOLDER: another PROGRAM works in this folder"
  FolderLock(const std::string& folder, const std::string& program);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

private:
  int descriptor_;
};
} // namespace fresco
