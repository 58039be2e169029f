// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/types.h>
#include <utility>
#include <vector>
namespace fresco::filters {
/// Disjoint sets (union by size, so that paths stay short) of elements that also have a sign against the root
/// of their set.
class ParityUnionFind {
public:
  explicit ParityUnionFind(Index n)
      : parent_(static_cast<std::size_t>(n)), size_(parent_.size(), 1), turned_(parent_.size())
  {
    for (Index i = 0; i < n; ++i)
      parent_[i] = static_cast<int>(i);
  }
  Index root(Index i) const
  {
    while (parent_[i] != i)
      i = parent_[i];
    return i;
  }
  int sign(Index i) const
  {
    bool turned = false;
    for (; parent_[i] != i; i = parent_[i])
      turned ^= turned_[i] != 0;
    return turned ? -1 : 1;
  }
  /// Joins the sets of i and j, in which the signs of i and j then are the same or opposite.
  void join(Index i, Index j, bool same)
  {
    const bool turned = (sign(i) == sign(j)) != same;
    Index a = root(i), b = root(j);
    if (a == b)
      return;
    if (size_[a] < size_[b])
      std::swap(a, b);
    parent_[b] = static_cast<int>(a);
    size_[a] += size_[b];
    turned_[b] = turned;
  }

private:
  std::vector<int> parent_, size_;
  std::vector<char> turned_; ///< against the parent
};
} // namespace fresco::filters
