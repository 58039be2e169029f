// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/unfinished_files.h>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <sys/stat.h>
#include <unistd.h>
namespace fresco {
namespace {
[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
  throw std::runtime_error(path + ": " + reason);
}

std::string besides(const std::string& path)
{
  const std::filesystem::path whole(path);
  // The extension stays last, since libraries choose a format by it.
  return (whole.parent_path() / ("." + whole.stem().string() + ".part" + whole.extension().string())).string();
}

constexpr std::size_t buffer_size = std::size_t{1} << 20;

/// Bytes per call of the operating system. A process cannot end, nor its file be removed, before the call under way
/// has: no call may have gigabytes to read or write, nor fsync() find gigabytes that wait for the disk.
constexpr std::size_t piece_size = std::size_t{8} << 20;

/// Temporary files that are neither renamed nor removed yet. Never destroyed: files may outlive main().
struct Unfinished {
  std::mutex mutex;
  std::set<std::string> paths;
  bool grouped = false;                      ///< an OutputGroup exists
  std::map<std::string, std::string> stored; ///< of that group: temporary files and their names to be
};

Unfinished& unfinished()
{
  static auto* const all = new Unfinished;
  return *all;
}

[[noreturn]] void failToWrite(const std::string& path)
{
  fail(path, std::string("cannot be written (") + std::strerror(errno) + ")");
}

/// To be called with the mutex locked.
void giveName(const std::string& temporary, const std::string& path)
{
  if (::rename(temporary.c_str(), path.c_str()) != 0)
    failToWrite(path);
  unfinished().paths.erase(temporary);
}
} // namespace

void abandonUnfinishedFiles() noexcept
{
  unfinished().mutex.lock(); // and never unlocked
  for (const std::string& path : unfinished().paths)
    ::unlink(path.c_str());
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)), temporary_(besides(path_))
{
  if (std::filesystem::path(path_).filename().empty() || std::filesystem::is_directory(path_))
    fail(path_, "is a folder, not a file to write to");
  const std::lock_guard<std::mutex> lock(unfinished().mutex);
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    failToWrite(path_);
  unfinished().paths.insert(temporary_);
}

OutputFile::~OutputFile()
{
  if (descriptor_ < 0)
    return;
  ::close(descriptor_);
  const std::lock_guard<std::mutex> lock(unfinished().mutex);
  ::unlink(temporary_.c_str());
  unfinished().paths.erase(temporary_);
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
  // A library may have replaced the file behind the descriptor, so the name is what counts.
  const bool stored = ::fsync(descriptor_) == 0 || errno == EINVAL;
  if (!stored)
    failToWrite(path_);
  const std::lock_guard<std::mutex> lock(unfinished().mutex);
  if (unfinished().grouped)
    unfinished().stored[temporary_] = path_;
  else
    giveName(temporary_, path_);
  ::close(descriptor_);
  descriptor_ = -1;
}

OutputGroup::OutputGroup()
{
  const std::lock_guard<std::mutex> lock(unfinished().mutex);
  require(!unfinished().grouped, "a group of outputs within another");
  unfinished().grouped = true;
}

OutputGroup::~OutputGroup()
{
  const std::lock_guard<std::mutex> lock(unfinished().mutex);
  for (const auto& [temporary, path] : unfinished().stored) {
    ::unlink(temporary.c_str());
    unfinished().paths.erase(temporary);
  }
  unfinished().stored.clear();
  unfinished().grouped = false;
}

void OutputGroup::commit()
{
  const std::lock_guard<std::mutex> lock(unfinished().mutex);
  auto& stored = unfinished().stored;
  for (auto file = stored.begin(); file != stored.end(); file = stored.erase(file))
    giveName(file->first, file->second);
}

std::string readFile(const std::string& path)
{
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    fail(path, "no such file");
  if (std::filesystem::is_directory(path, error))
    fail(path, "is a folder, not a file");
  std::ifstream file(path, std::ios::binary);
  if (!file)
    fail(path, std::string("cannot be read (") + std::strerror(errno) + ")");
  std::string content;
  const auto size = std::filesystem::file_size(path, error);
  content.resize(error ? 0 : size);
  std::size_t done = 0;
  while (file && done < content.size()) {
    file.read(&content[done], static_cast<std::streamsize>(std::min(piece_size, content.size() - done)));
    done += static_cast<std::size_t>(file.gcount());
  }
  content.resize(done);
  if (content.empty())
    fail(path, "the file is empty");
  return content;
}

void writeFile(const std::string& path, std::string_view content)
{
  OutputFile file(path);
  file.write(content);
  file.commit();
}

std::string extension(const std::string& path)
{
  std::string text = std::filesystem::path(path).extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

void makeFolder(const std::string& path)
{
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error || !std::filesystem::is_directory(path))
    fail(path, "the folder cannot be made (" + (error ? error.message() : "a file of that name is there") + ")");
  if (::access(path.c_str(), W_OK | X_OK) != 0)
    fail(path, std::string("the folder cannot be written to (") + std::strerror(errno) + ")");
}
} // namespace fresco
