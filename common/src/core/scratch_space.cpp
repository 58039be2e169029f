// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fresco/core/require.h>
#include <fresco/core/scratch_space.h>
#include <map>
#include <mutex>
#include <new>
#include <sys/mman.h>
#include <thread>
#include <unistd.h>
namespace fresco {
namespace {
struct Block {
  std::size_t bytes = 0;
  bool in_file = false;
};

/// Large arrays that were made while a ScratchSpace lived, by their start. They may outlive it.
struct Registry {
  std::mutex mutex;
  std::map<void*, Block> blocks;
  std::string folder;
  std::size_t memory = 0, in_memory = 0, in_files = 0, most_in_files = 0;
};

std::atomic<bool> active{false}, ever_active{false};

Registry& registry()
{
  static Registry* const all = new Registry; // never freed: static arrays may go after it
  return *all;
}

std::size_t pageSize()
{
  static const std::size_t size = sysconf(_SC_PAGESIZE);
  return size;
}

/// A file without a name. @throws std::runtime_error if it cannot be made
class NamelessFile {
public:
  explicit NamelessFile(const std::string& folder) : folder_(folder)
  {
    file_ = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (file_ >= 0)
      return;
    std::string name = folder + "/.fresco_scratch_XXXXXX"; // for file systems that know no files without names
    file_ = mkostemp(name.data(), O_CLOEXEC);
    if (file_ < 0)
      throw std::runtime_error(concat(folder, ": no scratch file can be made: ", std::strerror(errno)));
    unlink(name.c_str());
  }
  ~NamelessFile() { close(file_); }
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;

  /// @throws std::runtime_error if there is no space
  void reserve(std::size_t bytes) const
  {
    int error = 0;
    do
      error = posix_fallocate(file_, 0, bytes);
    while (error == EINTR);
    fail(error, bytes);
  }

  void* map(std::size_t bytes, void* at = nullptr, std::size_t offset = 0) const
  {
    void* const data =
        mmap(at, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | (at ? MAP_FIXED : 0), file_, static_cast<off_t>(offset));
    fail(data == MAP_FAILED ? errno : 0, bytes);
    return data;
  }

  void write(const char* data, std::size_t bytes, std::size_t offset) const
  {
    for (std::size_t done = 0; done < bytes;) {
      const ssize_t n = pwrite(file_, data + done, bytes - done, static_cast<off_t>(offset + done));
      fail(n < 0 && errno != EINTR ? errno : 0, bytes);
      done += std::max<ssize_t>(n, 0);
    }
  }

private:
  void fail(int error, std::size_t bytes) const
  {
    if (error != 0)
      throw std::runtime_error(
          concat(folder_, ": no scratch file of ", (bytes + 999999) / 1000000, " MB: ", std::strerror(error)));
  }

  const std::string folder_;
  int file_ = -1;
};

/// With the registry locked.
bool fitsInMemory(const Registry& all, std::size_t bytes)
{
  return all.in_memory + bytes <= ScratchSpace::keptInMemory(all.memory);
}

/// With the registry locked.
void note(Registry& all, void* start, Block block)
{
  all.blocks[start] = block;
  (block.in_file ? all.in_files : all.in_memory) += block.bytes;
  all.most_in_files = std::max(all.most_in_files, all.in_files);
}

/// What the block was; 0 bytes if it is none.
Block forget(void* start) noexcept
{
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto at = all.blocks.find(start);
  if (at == all.blocks.end())
    return {};
  const Block block = at->second;
  (block.in_file ? all.in_files : all.in_memory) -= block.bytes;
  all.blocks.erase(at);
  return block;
}

std::size_t residentBytes(std::FILE* statm)
{
  unsigned long size = 0, resident = 0;
  std::rewind(statm);
  std::fflush(statm); // else the next read takes what is buffered
  return std::fscanf(statm, "%lu %lu", &size, &resident) == 2 ? resident * pageSize() : 0;
}

void releasePages()
{
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  for (const auto& [start, block] : all.blocks)
    if (block.in_file)
      madvise(start, block.bytes, MADV_DONTNEED); // of a shared mapping: what was written stays in the file
}
} // namespace

/// The thread that lets go of pages.
class ScratchSpace::Watch {
public:
  explicit Watch(std::size_t memory) : most_(memory - memory / 8)
  {
    sigset_t every, before; // signals are for the threads that work
    sigfillset(&every);
    pthread_sigmask(SIG_SETMASK, &every, &before);
    thread_ = std::thread([this] { run(); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  ~Watch()
  {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

private:
  void run()
  {
    constexpr std::chrono::milliseconds pause(2); // two threads touch at most a few MB in that time
    std::FILE* const statm = std::fopen("/proc/self/statm", "r");
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, pause, [this] { return ended_; }))
      if (statm && residentBytes(statm) > most_)
        releasePages();
    if (statm)
      std::fclose(statm);
  }

  std::size_t most_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ended_ = false;
  std::thread thread_;
};

ScratchSpace::ScratchSpace(std::size_t memory, const std::string& folder)
{
  require(memory >= least_memory, "scratch space: ", memory, " bytes of memory are fewer than ", least_memory);
  Registry& all = registry();
  {
    const std::lock_guard lock(all.mutex);
    require(!active, "scratch space: there is one already");
    NamelessFile(folder).reserve(pageSize()); // an error now rather than after the points
    all.folder = folder;
    all.memory = memory;
    all.most_in_files = all.in_files;
    active = ever_active = true;
  }
  watch_ = std::make_unique<Watch>(memory);
}

ScratchSpace::~ScratchSpace() { active = false; }

std::size_t ScratchSpace::keptInMemory(std::size_t memory)
{
  constexpr std::size_t other = 192'000'000; // libraries, a window of points, what threads hold
  return memory > other ? (memory - other) / 2 : 0;
}

std::size_t ScratchSpace::mostBytes() const
{
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  return all.most_in_files;
}

FileBacking::FileBacking(void* data, std::size_t bytes)
{
  constexpr std::size_t least = std::size_t{64} << 20; // malloc gives such blocks pages of their own, and unmaps them
  constexpr std::size_t piece = std::size_t{16} << 20; // what is copied at a time stays resident
  if (!active || bytes < least)
    return;
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto address = reinterpret_cast<std::uintptr_t>(data), page = std::uintptr_t{pageSize()};
  const std::size_t before = (page - address % page) % page, whole = (bytes - before) / page * page;
  char* const start = static_cast<char*>(data) + before;
  const bool in_file = !fitsInMemory(all, whole);
  if (in_file) {
    const NamelessFile file(all.folder);
    file.reserve(whole);
    for (std::size_t at = 0; at < whole; at += piece) {
      const std::size_t count = std::min(piece, whole - at);
      file.write(start + at, count, at);
      file.map(count, start + at, at);
    }
  }
  note(all, start, {whole, in_file});
  start_ = start;
}

FileBacking::~FileBacking()
{
  if (start_)
    forget(start_);
}

namespace scratch {
void* allocate(std::size_t bytes)
{
  if (!active)
    return ::operator new(bytes);
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  Block block{bytes, !fitsInMemory(all, bytes)};
  void* start = nullptr;
  if (block.in_file) {
    const NamelessFile file(all.folder);
    file.reserve(bytes);
    start = file.map(bytes);
  } else {
    start = ::operator new(bytes);
  }
  note(all, start, block);
  return start;
}

void release(void* data) noexcept
{
  const Block block = ever_active ? forget(data) : Block();
  if (block.in_file)
    munmap(data, block.bytes);
  else
    ::operator delete(data);
}
} // namespace scratch
} // namespace fresco
