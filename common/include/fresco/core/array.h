// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/scratch_space.h>
#include <memory>
#include <new>
#include <utility>
#include <vector>
namespace fresco {
/// Leaves new numbers unset, so that the parallel loop that fills an array is also the first to touch its memory. Large
/// arrays may lie in a ScratchSpace.
template <typename T>
struct UnsetAllocator : std::allocator<T> {
  template <typename U>
  struct rebind {
    using other = UnsetAllocator<U>;
  };

  UnsetAllocator() = default;
  template <typename U>
  UnsetAllocator(const UnsetAllocator<U>&)
  {}

  T* allocate(std::size_t n)
  {
    if (n >= scratch::least_bytes / sizeof(T) && n <= std::size_t(-1) / 2 / sizeof(T))
      return static_cast<T*>(scratch::allocate(n * sizeof(T)));
    return std::allocator<T>::allocate(n);
  }
  void deallocate(T* data, std::size_t n) noexcept
  {
    if (n >= scratch::least_bytes / sizeof(T))
      scratch::release(data);
    else
      std::allocator<T>::deallocate(data, n);
  }

  template <typename U>
  void construct(U* place)
  {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments)
  {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// Array of numbers, or of plain structs of them, whose elements have no value until they are given one.
template <typename T>
using Array = std::vector<T, UnsetAllocator<T>>;
} // namespace fresco
