// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/expect.h"
#include "io/files/inputs.h"
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fresco/io/file.h>
#include <fresco/io/unfinished_files.h>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <sys/file.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
namespace fresco {
namespace {
namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
  throw std::runtime_error(path + ": " + reason);
}

[[noreturn]] void failToWrite(const std::string& path)
{
  fail(path, std::string("cannot be written (") + std::strerror(errno) + ")");
}

/// What the file system says of the file at `path`, nothing where none is. @throws std::runtime_error if it is anything but a file
std::optional<struct stat> replaced(const std::string& path)
{
  struct stat found = {};
  if (fs::path(path).filename().empty() || (::lstat(path.c_str(), &found) == 0 && S_ISDIR(found.st_mode)))
    fail(path, "is a folder, not a file to write to");
  if (found.st_mode == 0)
    return {};
  expect(S_ISREG(found.st_mode), path, ": is a link, a device or a pipe: only a file may be replaced");
  return found;
}

/// Owner, group and rights of the file that is replaced, as if it were written to in its place: no longer run with the rights of its
/// owner; and where its group cannot be kept, no other group has what that had.
void takeOver(const struct stat& old, int descriptor)
{
  const bool same_group =
      ::fchown(descriptor, old.st_uid, old.st_gid) == 0 || ::fchown(descriptor, uid_t(-1), old.st_gid) == 0;
  ::fchmod(descriptor, old.st_mode & (same_group ? 0777 : 0707 | (old.st_mode & 07) << 3));
}

/// Temporary names beside a file: `.STEM.`, 16 hexadecimal digits, `.part.EXTENSION`. The extension stays last, since
/// libraries choose a format by it.
struct TemporaryNames {
  static constexpr std::size_t digits = 16;
  static constexpr std::size_t longest_stem = 200; ///< bytes; file systems take names of 255
  fs::path folder;
  std::string begin, end;

  explicit TemporaryNames(const fs::path& path)
      : folder(path.parent_path()), begin("." + path.stem().string().substr(0, longest_stem) + "."),
        end(".part" + path.extension().string())
  {}
  std::string next() const
  {
    std::random_device random;
    char number[digits + 1];
    std::snprintf(number, sizeof(number), "%08x%08x", random(), random());
    return (folder / (begin + number + end)).string();
  }
  bool isOne(const std::string& name) const
  {
    return name.size() == begin.size() + digits + end.size() && name.compare(0, begin.size(), begin) == 0 &&
           name.compare(name.size() - end.size(), end.size(), end) == 0 &&
           name.find_first_not_of("0123456789abcdef", begin.size()) == begin.size() + digits;
  }
};

/// Locks an open file or folder for this process until it is closed. @return false if another has locked it; file
/// systems without locks count as free
bool lockedAlone(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

/// Removes what processes that were killed left beside a file: those that live hold a lock on theirs.
void removeLeftovers(const TemporaryNames& names)
{
  std::error_code error;
  const fs::path folder = names.folder.empty() ? fs::path(".") : names.folder;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    if (!names.isOne(entry->path().filename().string()))
      continue;
    const int left = ::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    struct stat found = {};
    if (left >= 0 && ::fstat(left, &found) == 0 && S_ISREG(found.st_mode) && ::flock(left, LOCK_EX | LOCK_NB) == 0)
      ::unlink(entry->path().c_str());
    if (left >= 0)
      ::close(left);
  }
}

constexpr std::size_t buffer_size = std::size_t{1} << 20;

/// Bytes per call of the operating system. A process cannot end, nor its file be removed, before the call under way
/// has: no call may have gigabytes to write, nor fsync() find gigabytes that wait for the disk.
constexpr std::size_t piece_size = std::size_t{8} << 20;

/// A file of a group that is written but not renamed.
struct Stored {
  std::string temporary, path;
  int descriptor; ///< holds the lock
};

/// What must go if the process ends now. Never destroyed: files may outlive main(). Nothing that can block is called
/// while the mutex is locked.
struct Unfinished {
  std::timed_mutex mutex;
  std::set<std::string> paths;      ///< temporary files that are neither renamed nor removed yet
  std::vector<std::string> folders; ///< made by makeFolder(), parents first
  std::thread::id grouped;          ///< the thread that has an OutputGroup; none: there is none
  std::vector<Stored> stored;       ///< of that group
};

Unfinished& unfinished()
{
  static auto* const all = new Unfinished;
  return *all;
}

using Lock = std::lock_guard<std::timed_mutex>;

/// To be called with the mutex locked.
void giveName(const std::string& temporary, const std::string& path)
{
  replaced(path); // what is there now may still be replaced
  if (::rename(temporary.c_str(), path.c_str()) != 0)
    failToWrite(path);
  unfinished().paths.erase(temporary);
}

/// Opens a new file that no other process removes. @return its descriptor, -1 with errno
int openTemporary(const std::string& path)
{
  addUnfinishedFile(path);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  struct stat made = {};
  if (descriptor >= 0 && lockedAlone(descriptor) && ::fstat(descriptor, &made) == 0 && made.st_nlink > 0)
    return descriptor;
  const int reason = descriptor < 0 ? errno : EEXIST; // taken for a leftover before it was locked
  if (descriptor >= 0)
    ::close(descriptor);
  const Lock lock(unfinished().mutex);
  unfinished().paths.erase(path);
  errno = reason;
  return -1;
}
} // namespace

void abandonUnfinishedFiles() noexcept
{
  // Never unlocked. Whoever holds it renames a file, which takes long on a dead network drive only.
  if (!unfinished().mutex.try_lock_for(std::chrono::seconds(2)))
    return;
  for (const std::string& path : unfinished().paths)
    ::unlink(path.c_str());
  for (auto folder = unfinished().folders.rbegin(); folder != unfinished().folders.rend(); ++folder)
    ::rmdir(folder->c_str());
}

void addUnfinishedFile(const std::string& path)
{
  const Lock lock(unfinished().mutex);
  unfinished().paths.insert(path);
}

void dropUnfinishedFile(const std::string& path) noexcept
{
  const Lock lock(unfinished().mutex);
  if (unfinished().paths.erase(path) > 0)
    ::unlink(path.c_str());
}

void removeEmptyFolders() noexcept
{
  const Lock lock(unfinished().mutex);
  for (auto& folders = unfinished().folders; !folders.empty(); folders.pop_back())
    ::rmdir(folders.back().c_str());
}

OutputFile::OutputFile(std::string path) : path_(std::move(path))
{
  replaced(path_);
  const TemporaryNames names(path_);
  removeLeftovers(names);
  constexpr int attempts = 10; // a name is taken by chance only, or by a process that removes leftovers
  for (int i = 0; i < attempts && descriptor_ < 0 && (i == 0 || errno == EEXIST); ++i) {
    temporary_ = names.next();
    descriptor_ = openTemporary(temporary_);
  }
  if (descriptor_ < 0)
    failToWrite(path_);
}

OutputFile::~OutputFile()
{
  if (descriptor_ < 0)
    return;
  dropUnfinishedFile(temporary_);
  ::close(descriptor_);
}

void OutputFile::write(const void* data, std::size_t bytes)
{
  const char* from = static_cast<const char*>(data);
  if (buffer_.size() + bytes > buffer_size)
    flush();
  if (bytes < buffer_size)
    buffer_.append(from, bytes);
  else
    store(from, bytes);
}

void OutputFile::flush()
{
  store(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void OutputFile::store(const char* from, std::size_t bytes)
{
  while (bytes > 0) {
    const ssize_t done = ::write(descriptor_, from, std::min(bytes, piece_size));
    if (done < 0 && errno == EINTR)
      continue;
    if (done < 0)
      failToWrite(path_);
    from += done;
    bytes -= static_cast<std::size_t>(done);
    written_ += static_cast<std::size_t>(done);
    if (written_ - sent_ >= piece_size)
      send();
  }
}

void OutputFile::send()
{
#ifdef __linux__
  const auto bytes = [](std::size_t at) { return static_cast<off64_t>(at); };
  int failed = ::sync_file_range(descriptor_, bytes(sent_), bytes(written_ - sent_), SYNC_FILE_RANGE_WRITE);
  if (failed == 0 && sent_ > awaited_) // a length of 0 would stand for the rest of the file
    failed = ::sync_file_range(descriptor_, bytes(awaited_), bytes(sent_ - awaited_), SYNC_FILE_RANGE_WAIT_BEFORE);
  if (failed != 0 && errno != ESPIPE && errno != EINVAL && errno != ENOSYS) // what cannot be synchronised so
    failToWrite(path_);
#endif
  awaited_ = sent_;
  sent_ = written_;
}

void OutputFile::commit()
{
  flush();
  if (const auto old = replaced(path_))
    takeOver(*old, descriptor_);
  // A library may have replaced the file behind the descriptor, so the name is what counts.
  const bool stored = ::fsync(descriptor_) == 0 || errno == EINVAL;
  if (!stored)
    failToWrite(path_);
  {
    const Lock lock(unfinished().mutex);
    if (unfinished().grouped == std::this_thread::get_id()) {
      unfinished().stored.push_back({temporary_, path_, descriptor_});
      descriptor_ = -1;
      return;
    }
    giveName(temporary_, path_);
  }
  ::close(descriptor_);
  descriptor_ = -1;
}

OutputGroup::OutputGroup()
{
  const Lock lock(unfinished().mutex);
  require(unfinished().grouped == std::thread::id(), "a group of outputs within another");
  unfinished().grouped = std::this_thread::get_id();
}

OutputGroup::~OutputGroup()
{
  const Lock lock(unfinished().mutex);
  for (const Stored& file : unfinished().stored) {
    if (unfinished().paths.erase(file.temporary) > 0)
      ::unlink(file.temporary.c_str());
    ::close(file.descriptor);
  }
  unfinished().stored.clear();
  unfinished().grouped = {};
}

void OutputGroup::requireNoInputs() const
{
  for (const Stored& file : unfinished().stored)
    expect(!io::wasRead(file.path), file.path, ": is an input, too, and inputs are not replaced");
}

void OutputGroup::commit()
{
  const Lock lock(unfinished().mutex);
  for (const Stored& file : unfinished().stored)
    giveName(file.temporary, file.path);
}

void writeFile(const std::string& path, std::string_view content)
{
  OutputFile file(path);
  file.write(content);
  file.commit();
}

void makeFolder(const std::string& path)
{
  std::vector<std::string> missing;
  std::error_code error;
  for (fs::path at = path; !at.empty() && !fs::exists(at, error); at = at.parent_path())
    missing.push_back(at.string());
  fs::create_directories(path, error);
  expect(!error && fs::is_directory(path), path, ": the folder cannot be made (",
         error ? error.message() : "a file of that name is there", ")");
  if (::access(path.c_str(), W_OK | X_OK) != 0)
    fail(path, std::string("the folder cannot be written to (") + std::strerror(errno) + ")");
  const Lock lock(unfinished().mutex);
  unfinished().folders.insert(unfinished().folders.end(), missing.rbegin(), missing.rend());
}

FolderLock::FolderLock(const std::string& folder, const std::string& program)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC))
{
  if (descriptor_ < 0)
    fail(folder, std::string("the folder cannot be read (") + std::strerror(errno) + ")");
  if (lockedAlone(descriptor_))
    return;
  ::close(descriptor_);
  fail(folder, "another " + program + " works in this folder");
}

FolderLock::~FolderLock() { ::close(descriptor_); }
} // namespace fresco
