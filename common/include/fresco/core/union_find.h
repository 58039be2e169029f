// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstdint>
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
} // namespace fresco
