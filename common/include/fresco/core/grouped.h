// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/types.h>
#include <numeric>
#include <vector>
namespace fresco {
/// Those of group g are list[begin[g]] .. list[begin[g + 1] - 1].
struct Groups {
  std::vector<Index> begin; ///< groups + 1
  std::vector<int> list;
};

/// The numbers 0 .. count - 1 by group, ascending within each; a counting sort.
/// @param groupOf groupOf(i) in 0 .. groups - 1
template <typename GroupOf>
Groups grouped(Index count, Index groups, const GroupOf& groupOf)
{
  Groups result{std::vector<Index>(groups + 1, 0), std::vector<int>(count)};
  for (Index i = 0; i < count; ++i)
    ++result.begin[groupOf(i) + 1];
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  std::vector<Index> next(result.begin.begin(), result.begin.end() - 1);
  for (Index i = 0; i < count; ++i)
    result.list[next[groupOf(i)]++] = i;
  return result;
}
} // namespace fresco
