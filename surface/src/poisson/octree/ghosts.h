// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstddef>
#include <fresco/core/exchange.h>
#include <functional>
#include <vector>
namespace fresco::poisson {
/// Consecutive bricks begin..end - 1.
struct BrickRun {
  int begin, end;
};

/// Which bricks of a depth are this rank's own, and which are ghosts: copies of bricks that touch the own ones and
/// belong to other ranks. Ghosts lie among the own bricks in the same sorted arrays, before or behind all of them. What
/// a loop over all bricks leaves in the ghosts is not right, because these lack bricks around them, until they are
/// refreshed from their owners.
struct Ghosts {
  /// Bricks of one colour after the other, see BrickLevel::colors; those of colour c are bricks[first[c]] ..
  /// bricks[first[c + 1] - 1].
  struct List {
    std::vector<int> bricks;
    std::array<int, 9> first{};
  };
  struct Peer {
    int rank;
    List send, receive;
  };

  /// Whether ghosts become NaN where nobody may read them, and before they are refreshed.
#ifdef NDEBUG
  static inline bool poison = false;
#else
  static inline bool poison = true;
#endif

  Exchange* exchange = nullptr; ///< nullptr: all bricks are on all ranks
  BrickRun own{0, 0};           ///< with several ranks, of depths where no brick lies on two of them
  std::vector<Peer> peers;

  bool isDivided() const { return exchange != nullptr; }

  /// Fills the ghosts from their owners. @param bytes of a brick. @param color -1 = all
  void swap(std::size_t bytes, const std::function<void(int brick, std::byte* message)>& pack,
            const std::function<void(int brick, const std::byte* message)>& unpack, int color = -1) const;

  /// The same of one value a brick.
  template <typename T>
  void refresh(T* values) const
  {
    swap(
        sizeof(T), [&](int b, std::byte* message) { std::copy_n(bytesOf(values + b), sizeof(T), message); },
        [&](int b, const std::byte* message) { std::copy_n(message, sizeof(T), bytesOf(values + b)); });
  }

private:
  template <typename T>
  static std::byte* bytesOf(T* value)
  {
    return reinterpret_cast<std::byte*>(value);
  }
};
} // namespace fresco::poisson
