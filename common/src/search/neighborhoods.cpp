// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <fresco/core/parallel.h>
#include <fresco/search/neighborhoods.h>
namespace fresco {
void Neighborhoods::numberGroups()
{
  group_of_leaf.clear();
  for (std::size_t g = 0; g < groups.size(); ++g)
    group_of_leaf.resize((groups[g].end + 7) / 8, g);
}

void GroupEncoder::begin(Index begin, Index end)
{
  lists_ = {};
  lists_.begin = begin;
  lists_.end = end;
  lists_.starts.reserve(end - begin + 1);
  lists_.starts.push_back(0);
  codes_.clear();
}

void GroupEncoder::add(const int* codes, std::size_t count)
{
  codes_.insert(codes_.end(), codes, codes + count);
  lists_.starts.push_back(codes_.size());
}

void GroupEncoder::replace(Index i, const int* codes, std::size_t count)
{
  std::copy_n(codes, count, codes_.begin() + lists_.starts[i - lists_.begin]);
}

GroupLists GroupEncoder::finish(const std::vector<int>& table, std::uint16_t* codes)
{
  constexpr int unused = -1, used = -2;
  const Index first = lists_.begin / 8, last = (lists_.end + 7) / 8;
  places_.assign(table.size(), unused);
  lists_.leaves.reserve(table.size());
  for (const int code : codes_)
    places_[code / 8] = used;
  for (Index leaf = first; leaf < last; ++leaf)
    lists_.leaves.push_back(leaf);
  for (std::size_t l = 0; l < table.size(); ++l) {
    if (table[l] >= first && table[l] < last) {
      places_[l] = table[l] - first;
    } else if (places_[l] == used) {
      places_[l] = lists_.leaves.size();
      lists_.leaves.push_back(table[l]);
    }
  }
  lists_.leaves.shrink_to_fit();
  lists_.codes = codes;
  std::transform(codes_.begin(), codes_.end(), codes,
                 [&](int code) -> std::uint16_t { return 8 * places_[code / 8] + code % 8; });
  const auto& starts = lists_.starts;
  lists_.length = starts.size() > 1 ? starts[1] : 0;
  bool even = true;
  for (std::size_t i = 0; i + 1 < starts.size(); ++i)
    even = even && starts[i + 1] - starts[i] == lists_.length;
  if (even)
    lists_.starts = {};
  return std::move(lists_);
}

void encodeLists(const NeighborLists& lists, int threads, Neighborhoods& all)
{
  Index longest = 1;
  for (Index i = 0; i < lists.size(); ++i)
    longest = std::max(longest, lists.count(i));
  const Index group_size = 8 * Neighborhoods::groupLeaves(longest);
  all.codes.resize(lists.index.size());
  all.groups.resize((lists.size() + group_size - 1) / group_size);
  parallelFor(all.groups.size(), threads, [&](Index g) {
    const Index begin = g * group_size, end = std::min(lists.size(), begin + group_size);
    std::vector<int> table, codes;
    for (const int* j = lists.first(begin); j != lists.first(end); ++j)
      table.push_back(*j / 8);
    std::sort(table.begin(), table.end());
    table.erase(std::unique(table.begin(), table.end()), table.end());
    GroupEncoder encoder;
    encoder.begin(begin, end);
    for (Index i = begin; i < end; ++i) {
      codes.clear();
      for (const int* j = lists.first(i); j != lists.last(i); ++j) {
        const int place = std::lower_bound(table.begin(), table.end(), *j / 8) - table.begin();
        codes.push_back(8 * place + *j % 8);
      }
      encoder.add(codes.data(), codes.size());
    }
    all.groups[g] = encoder.finish(table, all.codes.data() + (lists.begin[begin] - lists.begin[0]));
  });
  all.numberGroups();
}
} // namespace fresco
