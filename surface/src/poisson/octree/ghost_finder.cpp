// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/ghost_finder.h"
#include "poisson/octree/bytes.h"
#include <algorithm>
namespace fresco::poisson {
namespace {
using Codes = std::vector<std::uint64_t>;

int colorOf(std::uint64_t code) { return code >> 6 & 7; }

/// @param codes sorted
Ghosts::List listOf(const BrickLevel& level, const Codes& codes)
{
  Ghosts::List list;
  for (int color = 0; color < 8; ++color) {
    auto at = level.codes.begin();
    for (const std::uint64_t code : codes)
      if (colorOf(code) == color) {
        at = std::lower_bound(at, level.codes.end(), code);
        list.bricks.push_back(at - level.codes.begin());
      }
    list.first[color + 1] = list.bricks.size();
  }
  return list;
}
} // namespace

GhostFinder::GhostFinder(const Partition* partition, int depth) : partition_(partition), levels_(depth + 1) {}

GhostFinder::Codes GhostFinder::takeOwn(int depth, Codes codes) const
{
  std::vector<Bytes> to(partition_->ranks());
  auto begin = codes.cbegin();
  for (int r = 0; r < partition_->ranks(); ++r) {
    const auto end = std::lower_bound(begin, codes.cend(), partition_->codesOf(r, depth - 2).second);
    append(to[r], codes.data() + (begin - codes.cbegin()), end - begin);
    begin = end;
  }
  Codes own;
  for (const Bytes& part : partition_->exchange().deliver(std::move(to)))
    appendTo(own, part);
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  return own;
}

void GhostFinder::exchangeBricks(int depth, Codes& codes)
{
  if (!partition_ || depth <= partition_->sharedDepth())
    return;
  Exchange& exchange = partition_->exchange();
  const Codes own = takeOwn(depth, std::move(codes));
  std::vector<Bytes> to(partition_->ranks());
  std::vector<Codes> to_rank(partition_->ranks()), from_rank;
  std::vector<int> around;
  for (const std::uint64_t code : own) {
    partition_->ranksAround(depth - 2, code, around);
    for (const int rank : around)
      to_rank[rank].push_back(code);
  }
  for (int r = 0; r < partition_->ranks(); ++r)
    append(to[r], to_rank[r].data(), to_rank[r].size());
  for (const Bytes& part : exchange.deliver(std::move(to))) {
    from_rank.emplace_back();
    appendTo(from_rank.back(), part);
  }
  codes.clear();
  for (int r = 0; r < partition_->ranks(); ++r) {
    const Codes& part = r == partition_->rank() ? own : from_rank[r];
    codes.insert(codes.end(), part.begin(), part.end());
  }
  if (depth == partition_->sharedDepth() + 1) {
    const Array<std::uint64_t> all = gatherAll(exchange, own.data(), own.size());
    all_children_.assign(all.begin(), all.end());
  }
  levels_[depth] = {std::move(to_rank), std::move(from_rank)};
}

void GhostFinder::addTo(Octree& tree) const
{
  if (!partition_)
    return;
  tree.partition = partition_;
  for (int d = partition_->atomDepth() + 2; d <= tree.depth; ++d) {
    BrickLevel& level = tree.levels[d];
    Ghosts& ghosts = level.ghosts;
    const auto place = [&](std::uint64_t code) {
      return static_cast<int>(std::lower_bound(level.codes.begin(), level.codes.end(), code) - level.codes.begin());
    };
    const auto [first, last] = partition_->codesOf(partition_->rank(), d - 2);
    ghosts.own = {place(first), place(last)};
    if (!tree.isDivided(d))
      continue;
    ghosts.exchange = &partition_->exchange();
    for (int r = 0; r < partition_->ranks(); ++r)
      if (!levels_[d].to_rank[r].empty() || !levels_[d].from_rank[r].empty())
        ghosts.peers.push_back({r, listOf(level, levels_[d].to_rank[r]), listOf(level, levels_[d].from_rank[r])});
  }
  markRemoteChildren(tree.levels[partition_->sharedDepth()]);
}

void GhostFinder::markRemoteChildren(BrickLevel& level) const
{
  level.remote_children.assign(level.codes.size(), 0);
  std::size_t b = 0;
  for (const std::uint64_t code : all_children_) {
    while (level.codes[b] != code >> 3)
      ++b;
    if (level.child(b, code & 7) < 0)
      level.remote_children[b] |= 1 << (code & 7);
  }
}
} // namespace fresco::poisson
