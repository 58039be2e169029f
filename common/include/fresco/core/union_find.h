// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <fresco/core/array.h>
#include <fresco/core/parallel.h>
#include <fresco/core/types.h>
#include <numeric>
#include <vector>
namespace fresco {
/// Disjoint sets of 0..n-1, with path halving; the root of a set is its lowest element, so that results do not depend on
/// the order of joins.
class UnionFind {
public:
  /// @param n up to 2^32 - 1
  explicit UnionFind(Index n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

  Index root(Index i)
  {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(Index a, Index b)
  {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = static_cast<std::uint32_t>(std::min(a, b));
  }

private:
  std::vector<std::uint32_t> parent_;
};

/// The same, with sets that several threads join at a time.
class ConcurrentUnionFind {
public:
  /// @param n up to 2^32 - 1
  explicit ConcurrentUnionFind(Index n, int threads) : parent_(n)
  {
    parallelFor(n, threads, [&](Index i) { parent_[i].store(static_cast<std::uint32_t>(i), order); });
  }

  Index root(Index i)
  {
    for (;;) {
      std::uint32_t parent = parent_[i].load(order);
      const std::uint32_t above = parent_[parent].load(order);
      if (parent == above)
        return parent;
      parent_[i].compare_exchange_weak(parent, above, order); // else somebody else made the path shorter
      i = above;
    }
  }

  void join(Index a, Index b)
  {
    for (;;) {
      a = root(a);
      b = root(b);
      auto larger = static_cast<std::uint32_t>(std::max(a, b));
      if (a == b || parent_[larger].compare_exchange_strong(larger, static_cast<std::uint32_t>(std::min(a, b)), order))
        return;
    }
  }

private:
  static constexpr auto order = std::memory_order_relaxed; // parents only fall, and nothing else is told by them
  Array<std::atomic<std::uint32_t>> parent_;
};
} // namespace fresco
