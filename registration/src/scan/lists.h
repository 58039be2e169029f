// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <fresco/core/parallel.h>
#include <functional>
#include <type_traits>
#include <vector>
namespace fresco::registration {
/// body(i) for i = 0..n-1 in parallel, each a task: where one takes long against the start of a task.
template <typename Body>
void forEachTask(Index n, int threads, const Body& body)
{
  parallelFor(n, threads, body, 1);
}

/// What make(i) gives for i = 0..n-1, likewise; char in place of bool.
template <typename Make>
auto mapTasks(Index n, int threads, const Make& make)
{
  using Made = std::decay_t<decltype(make(n))>;
  std::vector<std::conditional_t<std::is_same_v<Made, bool>, char, Made>> made(n);
  forEachTask(n, threads, [&](Index i) { made[i] = make(i); });
  return made;
}

/// Largest first; what is equal keeps its order. @param key member or function of an item
template <typename List, typename Key>
void sortFalling(List& list, const Key& key)
{
  std::stable_sort(list.begin(), list.end(),
                   [&](const auto& x, const auto& y) { return std::invoke(key, x) > std::invoke(key, y); });
}

/// The largest, in falling order.
template <typename List, typename Key>
void keepLargest(List& list, std::size_t most, const Key& key)
{
  sortFalling(list, key);
  list.resize(std::min(most, list.size()));
}

/// @param unwanted member or function of an item
template <typename List, typename Unwanted>
void removeIf(List& list, const Unwanted& unwanted)
{
  const auto is_unwanted = [&](const auto& item) { return std::invoke(unwanted, item); };
  list.erase(std::remove_if(list.begin(), list.end(), is_unwanted), list.end());
}
} // namespace fresco::registration
