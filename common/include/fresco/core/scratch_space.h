// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/export.h>
#include <memory>
#include <string>
#include <utility>
namespace fresco {
/// While it lives, large arrays of the process (Array, and what a FileBacking holds) lie in files of a folder once those
/// in memory take keptInMemory(). A thread watches the resident memory, and lets go of the pages of such files before
/// it exceeds `memory`: they come back from the system's cache, or from the files. No value changes by it. The files
/// have no names and go with their arrays, whatever ends the process; their space is allocated beforehand. At most one
/// at a time. Linux.
class FRESCO_EXPORT ScratchSpace {
public:
  static constexpr std::size_t least_memory = 256'000'000;

  /// @param memory bytes that the process may keep resident, at least `least_memory`; all that it holds counts
  /// @throws std::invalid_argument if there is one already or `memory` is too small
  /// @throws std::runtime_error    if no file can be made in the folder
  ScratchSpace(std::size_t memory, const std::string& folder);
  ~ScratchSpace();
  ScratchSpace(const ScratchSpace&) = delete;
  ScratchSpace& operator=(const ScratchSpace&) = delete;

  static std::size_t keptInMemory(std::size_t memory); ///< bytes of large arrays; further ones go to files
  std::size_t mostBytes() const;                       ///< the most that its files held at one time

private:
  class Watch;
  std::unique_ptr<Watch> watch_;
};

/// Puts a large matrix of Eigen, which allocates its own memory, under the ScratchSpace for as long as this lives. It
/// must neither be resized nor freed meanwhile; it may be moved. Does nothing without a ScratchSpace.
class FRESCO_EXPORT FileBacking {
public:
  FileBacking() = default;
  template <typename Matrix>
  explicit FileBacking(Matrix& matrix) : FileBacking(matrix.data(), matrix.size() * sizeof(typename Matrix::Scalar))
  {}
  FileBacking(FileBacking&& other) noexcept : start_(other.start_) { other.start_ = nullptr; }
  FileBacking& operator=(FileBacking&& other) noexcept
  {
    std::swap(start_, other.start_);
    return *this;
  }
  ~FileBacking();

private:
  /// @throws std::runtime_error if the scratch space is full
  FileBacking(void* data, std::size_t bytes);
  void* start_ = nullptr;
};

namespace scratch {
constexpr std::size_t least_bytes = std::size_t{4} << 20; ///< smaller arrays stay in memory

/// Memory for a large array, in a file where the ScratchSpace says so. @throws std::runtime_error if that is full
FRESCO_EXPORT void* allocate(std::size_t bytes);
FRESCO_EXPORT void release(void* data) noexcept;
} // namespace scratch
} // namespace fresco
