// SPDX-License-Identifier: BSD-3-Clause
#include "search/tree_items.h"
#include <algorithm>
#include <cstddef>
namespace fresco::search {
namespace {
constexpr std::ptrdiff_t few = 32; // sorted by comparing all with all

/// The place of each of `count` values in ascending order, equal ones in their order. @param count up to `few`
void rankValues(const float* values, std::ptrdiff_t count, int* ranks)
{
  bool taken[few] = {};
  std::fill(ranks, ranks + count, 0);
  for (std::ptrdiff_t j = 0; j < count; ++j)
    for (std::ptrdiff_t i = 0; i < count; ++i)
      ranks[i] += values[j] < values[i];
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    while (taken[ranks[i]])
      ++ranks[i];
    taken[ranks[i]] = true;
  }
}

void sortFew(TreeItem* begin, TreeItem* end, int axis)
{
  float values[few] = {};
  int ranks[few];
  TreeItem sorted[few];
  const std::ptrdiff_t count = end - begin;
  for (std::ptrdiff_t i = 0; i < count; ++i)
    values[i] = begin[i].x[axis];
  rankValues(values, count, ranks);
  for (std::ptrdiff_t i = 0; i < count; ++i)
    sorted[ranks[i]] = begin[i];
  std::copy(sorted, sorted + count, begin);
}

/// A value that about as many items are below as are before `middle`, from a sample.
float pivotFor(const TreeItem* begin, const TreeItem* middle, const TreeItem* end, int axis)
{
  float values[few] = {};
  int ranks[few];
  const std::ptrdiff_t count = end - begin, sample = count > 8 * few ? few : few / 4 + 1;
  for (std::ptrdiff_t i = 0; i < sample; ++i)
    values[i] = begin[(2 * i + 1) * count / (2 * sample)].x[axis];
  rankValues(values, sample, ranks);
  const std::ptrdiff_t wanted = std::min((middle - begin) * sample / count, sample - 1);
  std::ptrdiff_t at = 0;
  while (ranks[at] != wanted)
    ++at;
  return values[at];
}

/// Items below `pivot` first. @return the first of the others
TreeItem* partition(TreeItem* begin, TreeItem* end, int axis, float pivot)
{
  TreeItem* border = begin;
  for (TreeItem* at = begin; at != end; ++at) {
    const TreeItem item = *at;
    *at = *border;
    *border = item;
    border += item.x[axis] < pivot;
  }
  return border;
}
} // namespace

void selectMiddle(TreeItem* begin, TreeItem* middle, TreeItem* end, int axis)
{
  while (end - begin > few) {
    TreeItem* border = partition(begin, end, axis, pivotFor(begin, middle, end, axis));
    if (border == begin) { // the pivot is the least: many are equal
      const auto less = [axis](const TreeItem& a, const TreeItem& b) { return a.x[axis] < b.x[axis]; };
      std::nth_element(begin, middle, end, less);
      return;
    }
    if (border == middle)
      return;
    (border < middle ? begin : end) = border;
  }
  sortFew(begin, end, axis);
}
} // namespace fresco::search
