// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/partition.h"
#include <algorithm>
#include <fresco/core/morton.h>
namespace fresco::poisson {
namespace {
/// Code of a cell as one of so many depths deeper.
std::uint64_t shifted(std::uint64_t code, int levels) { return levels < 0 ? code >> -3 * levels : code << 3 * levels; }
} // namespace

Partition::Partition(Exchange& exchange, int shared_depth, std::vector<std::uint64_t> first_atoms)
    : exchange_(&exchange), shared_depth_(shared_depth), first_atoms_(std::move(first_atoms))
{
  first_atoms_.push_back(atomCount(shared_depth));
}

std::vector<std::uint64_t> Partition::evenly(const std::vector<std::int64_t>& load, int ranks)
{
  std::vector<std::uint64_t> first;
  std::int64_t all = 0, before = 0;
  for (const std::int64_t l : load)
    all += l;
  std::uint64_t atom = 0;
  for (int r = 0; r < ranks; ++r) {
    while (atom < load.size() && (before + load[atom] / 2) * ranks < all * r)
      before += load[atom++];
    first.push_back(atom);
  }
  first[0] = 0;
  return first;
}

int Partition::ownerOf(int depth, std::uint64_t code) const
{
  const std::uint64_t atom = shifted(code, atomDepth() - depth);
  return std::upper_bound(first_atoms_.begin(), first_atoms_.end() - 1, atom) - first_atoms_.begin() - 1;
}

std::pair<std::uint64_t, std::uint64_t> Partition::codesOf(int rank, int depth) const
{
  const int levels = depth - atomDepth();
  return {shifted(first_atoms_[rank], levels), shifted(first_atoms_[rank + 1], levels)};
}

std::pair<Index, Index> Partition::rangeOf(int rank, int depth, const Array<std::uint64_t>& codes) const
{
  const auto [first, last] = codesOf(rank, depth);
  const auto begin = std::lower_bound(codes.begin(), codes.end(), first);
  return {begin - codes.begin(), std::lower_bound(begin, codes.end(), last) - codes.begin()};
}

void Partition::ranksAround(int depth, std::uint64_t code, std::vector<int>& ranks) const
{
  ranks.clear();
  const auto cell = mortonCell(code);
  const int within = (1 << (depth - atomDepth())) - 1, side = 1 << depth;
  const auto isInside = [&](int c) { return (c & within) != 0 && (c & within) != within; };
  if (std::all_of(cell.begin(), cell.end(), isInside))
    return;
  for (int o = 0; o < 27; ++o) {
    const int x = cell[0] + o % 3 - 1, y = cell[1] + o / 3 % 3 - 1, z = cell[2] + o / 9 - 1;
    if (std::min({x, y, z}) >= 0 && std::max({x, y, z}) < side)
      if (const int owner = ownerOf(depth, mortonCode(x, y, z)); owner != rank())
        ranks.push_back(owner);
  }
  std::sort(ranks.begin(), ranks.end());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
}
} // namespace fresco::poisson
