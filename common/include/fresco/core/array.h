// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <new>
#include <utility>
#include <vector>
namespace fresco {
/// Leaves new numbers unset, so that the parallel loop that fills an array is also the first to touch its memory.
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
