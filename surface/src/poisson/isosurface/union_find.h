// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <fresco/core/types.h>
#include <vector>
namespace fresco::poisson {
/// Union-find; the root of a set is its lowest element.
class DisjointSets {
public:
  explicit DisjointSets(Index count) : parent_(static_cast<std::size_t>(count))
  {
    for (std::size_t v = 0; v < parent_.size(); ++v)
      parent_[v] = static_cast<int>(v);
  }

  int root(int v)
  {
    while (at(v) != v) {
      at(v) = at(at(v));
      v = at(v);
    }
    return v;
  }

  void join(int a, int b)
  {
    a = root(a);
    b = root(b);
    at(std::max(a, b)) = std::min(a, b);
  }

private:
  int& at(int v) { return parent_[static_cast<std::size_t>(v)]; }
  std::vector<int> parent_;
};
} // namespace fresco::poisson
